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
    constructor(problem: Problem);
    problem: Problem;
}
export class Lastflat {
    /**
     * @param {string} url The service's address.
     * @param {{key?: string, fetch?: typeof fetch}} [options] `key`: an API key or a token.
     */
    constructor(url: string, options?: {
        key?: string;
        fetch?: typeof fetch;
    });
    url: string;
    key: string | undefined;
    fetch: typeof fetch;
    /**
     * Keeps a model, so that many requests can be made of it. The same bytes are kept once.
     * @param {BodyInit} bytes
     * @param {AbortSignal} [signal]
     * @returns {Promise<Asset>}
     */
    upload(bytes: BodyInit, signal?: AbortSignal): Promise<Asset>;
    /**
     * Makes a job of a kept model. `once`, a text of your own, makes it one job however often it is sent; `fresh` has it
     * run even if its result is there.
     * @param {string} assetId
     * @param {FlattenRequest} [request]
     * @param {{once?: string, fresh?: boolean, signal?: AbortSignal}} [options]
     * @returns {Promise<Job>}
     */
    submit(assetId: string, request?: FlattenRequest, options?: {
        once?: string;
        fresh?: boolean;
        signal?: AbortSignal;
    }): Promise<Job>;
    /**
     * Makes a job and follows it to its end; throws what it failed of. Given up by `signal`, it is canceled.
     * @param {string} assetId
     * @param {FlattenRequest} [request]
     * @param {{onProgress?: (progress: Progress) => void, fresh?: boolean, signal?: AbortSignal}} [options]
     * @returns {Promise<Job>} a job that has succeeded
     */
    flatten(assetId: string, request?: FlattenRequest, options?: {
        onProgress?: (progress: Progress) => void;
        fresh?: boolean;
        signal?: AbortSignal;
    }): Promise<Job>;
    /**
     * @param {string} id
     * @param {{wait?: number, signal?: AbortSignal}} [options] `wait`: up to so many seconds for its end.
     * @returns {Promise<Job>}
     */
    job(id: string, options?: {
        wait?: number;
        signal?: AbortSignal;
    }): Promise<Job>;
    /**
     * The job's events as they happen: `state`, `progress`, `log`, and `done` with the job. A stream that breaks off
     * ends here; `flatten` goes on with `job`.
     * @param {string} id
     * @param {AbortSignal} [signal]
     * @returns {AsyncGenerator<ServerEvent>}
     */
    events(id: string, signal?: AbortSignal): AsyncGenerator<ServerEvent>;
    /**
     * @param {string} id
     * @param {AbortSignal} [signal]
     * @returns {Promise<FlattenResult>}
     */
    result(id: string, signal?: AbortSignal): Promise<FlattenResult>;
    /**
     * A file of the result; `png` is a small picture of it.
     * @param {string} id
     * @param {"json" | "svg" | "png" | "glb" | "obj"} format
     * @param {AbortSignal} [signal]
     * @returns {Promise<Blob>}
     */
    file(id: string, format: "json" | "svg" | "png" | "glb" | "obj", signal?: AbortSignal): Promise<Blob>;
    /** @param {string} id */
    cancel(id: string): Promise<void>;
    #private;
}
/**
 * What the service says is wrong (RFC 9457). `code` is stable; `pointer` names the field of what was sent; `curve` and
 * `position` (mm) the place on the last.
 */
export type Problem = {
    status: number;
    code: string;
    title: string;
    detail: string;
    pointer?: string;
    curve?: string;
    position?: number[];
};
/**
 * What the service says is wrong (RFC 9457). `code` is stable; `pointer` names the field of what was sent; `curve` and
 * `position` (mm) the place on the last.
 */
export type JobState = "queued" | "running" | "canceling" | "succeeded" | "failed" | "canceled";
/**
 * What the service says is wrong (RFC 9457). `code` is stable; `pointer` names the field of what was sent; `curve` and
 * `position` (mm) the place on the last.
 */
export type Progress = {
    stage: string;
    percent: number;
};
/**
 * What the service says is wrong (RFC 9457). `code` is stable; `pointer` names the field of what was sent; `curve` and
 * `position` (mm) the place on the last.
 */
export type Job = {
    id: string;
    state: JobState;
    tag?: string;
    progress: Progress;
    error?: Problem;
    links: {
        self: string;
        result: string;
        metrics: string;
        events: string;
        cancel: string;
    };
};
/**
 * What the service says is wrong (RFC 9457). `code` is stable; `pointer` names the field of what was sent; `curve` and
 * `position` (mm) the place on the last.
 */
export type Asset = {
    id: string;
    bytes: number;
};
/**
 * The constraint JSON, `FlattenRequest` of /openapi.json.
 */
export type FlattenRequest = Record<string, unknown>;
/**
 * What the service says is wrong (RFC 9457). `code` is stable; `pointer` names the field of what was sent; `curve` and
 * `position` (mm) the place on the last.
 */
export type CurveResult = {
    name: string;
    locked: boolean;
    length_3d_mm: number;
    length_2d_mm: number;
    error_mm: number;
    verdict?: "pass" | "fail";
};
/**
 * What the service says is wrong (RFC 9457). `code` is stable; `pointer` names the field of what was sent; `curve` and
 * `position` (mm) the place on the last.
 */
export type RegionResult = {
    name: string;
    uv_mm: number[][];
    triangles: number[][];
    source_vertices: (number | null)[];
    source_points: {
        vertex: number;
        triangle: number[];
        weights: number[];
    }[];
    source_triangles: (number | null)[];
    curves: CurveResult[];
};
/**
 * What the service says is wrong (RFC 9457). `code` is stable; `pointer` names the field of what was sent; `curve` and
 * `position` (mm) the place on the last.
 */
export type Placement = {
    region: string;
    rotation_deg: number;
    translation_mm: number[];
    mirrored: boolean;
};
/**
 * What the service says is wrong (RFC 9457). `code` is stable; `pointer` names the field of what was sent; `curve` and
 * `position` (mm) the place on the last.
 */
export type FlattenResult = {
    regions: RegionResult[];
    model: {
        vertices: number;
        triangles: number;
        welded_to: number[];
        seam_vertices: {
            source_vertex: number;
            places: {
                region: string;
                vertex: number;
            }[];
        }[];
    };
    layout: {
        width_mm: number;
        height_mm: number;
        placements: Placement[];
    };
    warnings: {
        code: string;
        detail: string;
    }[];
};
/**
 * What the service says is wrong (RFC 9457). `code` is stable; `pointer` names the field of what was sent; `curve` and
 * `position` (mm) the place on the last.
 */
export type ServerEvent = {
    event: string;
    data: any;
};
