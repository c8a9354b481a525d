// A client of the service, for Node 18 and browsers, as it stands: no build step, nothing to install.
//
//   const service = new Lastflat("http://127.0.0.1:8080", {key});
//   const asset = await service.upload(bytes);                       // once
//   const job = await service.flatten(asset.id, request, {onProgress: (p) => console.log(p.stage, p.percent)});
//   const result = await service.result(job.id);                     // uv_mm, curves, certificates

/**
 * What the service says is wrong (RFC 9457). `code` is stable; `pointer` names the field of what was sent; `curve` and
 * `position` (mm) the place on the last.
 * @typedef {{status: number, code: string, title: string, detail: string, pointer?: string, curve?: string,
 *   position?: number[]}} Problem
 *
 * @typedef {"queued" | "running" | "canceling" | "succeeded" | "failed" | "canceled"} JobState
 * @typedef {{stage: string, percent: number}} Progress
 * @typedef {{id: string, state: JobState, tag?: string, progress: Progress, error?: Problem,
 *   links: {self: string, result: string, metrics: string, events: string, cancel: string}}} Job
 * @typedef {{id: string, bytes: number}} Asset
 * @typedef {Record<string, unknown>} FlattenRequest The constraint JSON, `FlattenRequest` of /openapi.json.
 * @typedef {{name: string, locked: boolean, length_3d_mm: number, length_2d_mm: number, error_mm: number,
 *   verdict?: "pass" | "fail"}} CurveResult
 * @typedef {{name: string, uv_mm: number[][], triangles: number[][], source_vertices: (number | null)[],
 *   source_points: {vertex: number, triangle: number[], weights: number[]}[], source_triangles: (number | null)[],
 *   curves: CurveResult[]}} RegionResult
 * @typedef {{region: string, rotation_deg: number, translation_mm: number[], mirrored: boolean}} Placement
 * @typedef {{regions: RegionResult[], model: {vertices: number, triangles: number, welded_to: number[],
 *     seam_vertices: {source_vertex: number, places: {region: string, vertex: number}[]}[]},
 *   layout: {width_mm: number, height_mm: number, placements: Placement[]},
 *   warnings: {code: string, detail: string}[]}} FlattenResult
 * @typedef {{event: string, data: any}} ServerEvent
 */

/** An answer that is a problem, or a job that failed. */
export class LastflatError extends Error {
  /** @param {Problem} problem */
  constructor(problem) {
    super(problem.detail + (problem.pointer ? ` (at ${problem.pointer})` : ""));
    this.name = "LastflatError";
    this.problem = problem;
  }
}

const ended = ["succeeded", "failed", "canceled"];

export class Lastflat {
  /**
   * @param {string} url The service's address.
   * @param {{key?: string, fetch?: typeof fetch}} [options] `key`: an API key or a token.
   */
  constructor(url, options = {}) {
    this.url = url.replace(/\/+$/, "");
    this.key = options.key;
    this.fetch = options.fetch ?? globalThis.fetch.bind(globalThis);
  }

  /**
   * Keeps a model, so that many requests can be made of it. The same bytes are kept once.
   * @param {BodyInit} bytes
   * @param {AbortSignal} [signal]
   * @returns {Promise<Asset>}
   */
  async upload(bytes, signal) {
    const headers = {"Content-Type": "application/octet-stream"};
    return (await this.#ask("/v1/assets", {method: "POST", headers, body: bytes, signal})).json();
  }

  /**
   * Makes a job of a kept model. `once`, a text of your own, makes it one job however often it is sent; `fresh` has it
   * run even if its result is there.
   * @param {string} assetId
   * @param {FlattenRequest} [request]
   * @param {{once?: string, fresh?: boolean, signal?: AbortSignal}} [options]
   * @returns {Promise<Job>}
   */
  async submit(assetId, request = {}, options = {}) {
    /** @type {Record<string, string>} */
    const headers = {"Content-Type": "application/json"};
    if (options.once) headers["Idempotency-Key"] = options.once;
    if (options.fresh) headers["Cache-Control"] = "no-cache";
    const body = JSON.stringify({model: {asset_id: assetId}, request});
    return (await this.#ask("/v1/jobs", {method: "POST", headers, body, signal: options.signal})).json();
  }

  /**
   * Makes a job and follows it to its end; throws what it failed of. Given up by `signal`, it is canceled.
   * @param {string} assetId
   * @param {FlattenRequest} [request]
   * @param {{onProgress?: (progress: Progress) => void, fresh?: boolean, signal?: AbortSignal}} [options]
   * @returns {Promise<Job>} a job that has succeeded
   */
  async flatten(assetId, request = {}, options = {}) {
    const {fresh, signal} = options;
    const once = oneTimeText();
    try {
      return await this.#follow(await this.submit(assetId, request, {once, fresh, signal}), options);
    } catch (error) {
      if (signal?.aborted) await this.#takeBack(assetId, request, {once, fresh});
      throw error;
    }
  }

  /**
   * Cancels what may have been sent: the same once more says which job it is.
   * @param {string} assetId
   * @param {FlattenRequest} request
   * @param {{once: string, fresh?: boolean}} options
   */
  async #takeBack(assetId, request, options) {
    try {
      await this.cancel((await this.submit(assetId, request, options)).id);
    } catch (error) {
      if (mayPass(error)) throw error;  // else it has ended, or was never taken
    }
  }

  /**
   * @param {string} id
   * @param {{wait?: number, signal?: AbortSignal}} [options] `wait`: up to so many seconds for its end.
   * @returns {Promise<Job>}
   */
  async job(id, options = {}) {
    /** @type {Record<string, string>} */
    const headers = options.wait ? {Prefer: `wait=${options.wait}`} : {};
    return (await this.#ask(`/v1/jobs/${id}`, {headers, signal: options.signal})).json();
  }

  /**
   * The job's events as they happen: `state`, `progress`, `log`, and `done` with the job. A stream that breaks off
   * ends here; `flatten` goes on with `job`.
   * @param {string} id
   * @param {AbortSignal} [signal]
   * @returns {AsyncGenerator<ServerEvent>}
   */
  async *events(id, signal) {
    const answer = await this.#ask(`/v1/jobs/${id}/events`, {headers: {Accept: "text/event-stream"}, signal});
    const reader = /** @type {ReadableStream<Uint8Array>} */ (answer.body).getReader();
    const decoder = new TextDecoder();
    let text = "";
    try {
      for (;;) {
        const {done, value} = await reader.read();
        if (done) return;
        text += decoder.decode(value, {stream: true});
        const events = text.split("\n\n");
        text = /** @type {string} */ (events.pop());
        for (const event of events.map(parseEvent)) if (event) yield event;
      }
    } finally {
      await reader.cancel().catch(() => undefined);  // who stops listening closes the stream
    }
  }

  /**
   * @param {string} id
   * @param {AbortSignal} [signal]
   * @returns {Promise<FlattenResult>}
   */
  async result(id, signal) {
    return (await this.#ask(`/v1/jobs/${id}/result`, {headers: {Accept: "application/json"}, signal})).json();
  }

  /**
   * A file of the result; `png` is a small picture of it.
   * @param {string} id
   * @param {"json" | "svg" | "png" | "glb" | "obj"} format
   * @param {AbortSignal} [signal]
   * @returns {Promise<Blob>}
   */
  async file(id, format, signal) {
    return (await this.#ask(`/v1/jobs/${id}/result.${format}`, {signal})).blob();
  }

  /** @param {string} id */
  async cancel(id) {
    await this.#ask(`/v1/jobs/${id}/cancel`, {method: "POST"});
  }

  /**
   * @param {Job} job
   * @param {{onProgress?: (progress: Progress) => void, signal?: AbortSignal}} options
   * @returns {Promise<Job>}
   */
  async #follow(job, {onProgress, signal}) {
    const stream = this.events(job.id, signal);
    /**
     * A stream that cannot be had or breaks off has ended.
     * @returns {Promise<IteratorResult<ServerEvent, void>>}
     */
    const next = async () => {
      try {
        return await stream.next();
      } catch (error) {
        if (signal?.aborted || !mayPass(error)) throw error;
        return {done: true, value: undefined};
      }
    };
    for (let read = await next(); !read.done; read = await next()) {
      if (read.value.event === "progress") onProgress?.(read.value.data);
      if (read.value.event === "done") job = read.value.data;
    }
    while (!ended.includes(job.state)) {
      job = await this.job(job.id, {wait: 30, signal});
      if (ended.includes(job.state)) break;
      onProgress?.(job.progress);
      await pause(1000, signal);  // all places to wait may be taken: then the answer comes at once
    }
    if (job.state === "succeeded") return job;
    throw new LastflatError(job.error ?? {status: 409, code: "canceled", title: "canceled", detail: "the job was canceled"});
  }

  /**
   * An answer that is no problem. What is refused for the moment (429, 503) is asked again, and so is, unless that may
   * make a second job, what did not come through.
   * @param {string} path
   * @param {RequestInit & {headers?: Record<string, string>}} init
   * @returns {Promise<Response>}
   */
  async #ask(path, init) {
    const headers = {...init.headers, ...(this.key ? {Authorization: `Bearer ${this.key}`} : {})};
    const isOnce = path !== "/v1/jobs" || "Idempotency-Key" in headers;
    for (let attempt = 0; ; ++attempt) {
      const isLast = attempt === 4 || init.body instanceof ReadableStream;  // a stream is read once
      /** @type {Response} */
      let answer;
      try {
        answer = await this.fetch(this.url + path, {...init, headers});
      } catch (error) {
        if (init.signal?.aborted || !isOnce || isLast) throw error;
        await pause(500 * 2 ** attempt, init.signal);
        continue;
      }
      if (answer.ok) return answer;
      const error = new LastflatError(await problemOf(answer));
      if (!mayPass(error) || isLast) throw error;
      await pause(retryAfter(answer), init.signal);
    }
  }
}

/** No secret: it only has to be another one each time. (`crypto.randomUUID` is missing in Node 18 and on http pages.) */
function oneTimeText() {
  return [Date.now(), Math.random(), Math.random()].map((number) => number.toString(36).replace(".", "")).join("-");
}

/**
 * Milliseconds until asking again is of use: a number of seconds, or a date.
 * @param {Response} answer
 */
function retryAfter(answer) {
  const value = answer.headers.get("Retry-After") ?? "1";
  const wait = /^\d+$/.test(value) ? 1000 * Number(value) : Date.parse(value) - Date.now();
  return Math.min(Math.max(wait || 0, 100), 60_000);
}

/** @param {unknown} error Whether asking again may help. */
function mayPass(error) {
  return !(error instanceof LastflatError) || [429, 503].includes(error.problem.status);
}

/**
 * @param {Response} answer
 * @returns {Promise<Problem>}
 */
async function problemOf(answer) {
  const text = await answer.text();
  if (answer.headers.get("Content-Type")?.startsWith("application/problem+json")) return JSON.parse(text);
  return {status: answer.status, code: "unknown", title: answer.statusText, detail: `the answer is ${answer.status}`};
}

/**
 * @param {string} text
 * @returns {ServerEvent | undefined} nothing: a comment that keeps the connection open
 */
function parseEvent(text) {
  const lines = text.split("\n").map((line) => line.split(/: ?(.*)/s, 2));
  const event = lines.find(([name]) => name === "event")?.[1];
  const data = lines.filter(([name]) => name === "data").map(([, value]) => value).join("\n");
  return event ? {event, data: JSON.parse(data || "null")} : undefined;
}

/**
 * @param {number} milliseconds
 * @param {AbortSignal | null} [signal]
 */
function pause(milliseconds, signal) {
  return new Promise((resolve, reject) => {
    const stop = () => { clearTimeout(timer); reject(signal?.reason); };
    const timer = setTimeout(() => { signal?.removeEventListener("abort", stop); resolve(undefined); }, milliseconds);
    if (signal?.aborted) stop();
    signal?.addEventListener("abort", stop, {once: true});
  });
}
