// The JavaScript client on a bad line. Usage: faults.mjs URL MODEL
import assert from "node:assert/strict";
import {readFile} from "node:fs/promises";
import {Lastflat, LastflatError} from "./javascript/lastflat.js";

const [url, model] = process.argv.slice(2);
let asked = [];

/** Every request fails first: before it is sent, or after it was answered. */
function badLine(afterwards) {
  const failed = new Set();
  return async (input, init) => {
    asked.push(`${init.method ?? "GET"} ${input.slice(url.length)}`);
    const isFirst = !failed.has(input);
    failed.add(input);
    if (isFirst && !afterwards) throw new TypeError("fetch failed");
    const answer = await fetch(input, init);
    if (isFirst) throw new TypeError("terminated");
    return answer;
  };
}

for (const afterwards of [false, true]) {
  const service = new Lastflat(url, {fetch: badLine(afterwards)});
  const asset = await service.upload(await readFile(model));
  const job = await service.flatten(asset.id, {tag: String(afterwards)}, {fresh: true});
  assert.equal(job.state, "succeeded");
  assert.equal((await service.result(job.id)).regions.length > 0, true);
  const listed = await (await fetch(`${url}/v1/jobs?tag=${afterwards}`)).json();
  assert.equal(listed.items.length, 1, "what was sent twice is one job");
}

const plain = new Lastflat(url, {fetch: badLine(false)});
const asset = await new Lastflat(url).upload(await readFile(model));
await assert.rejects(plain.submit(asset.id), TypeError, "without `once` a second job could come of it");

// Given up while it is being sent: the job that came of it, behind others, is canceled.
await Promise.all(Array.from({length: 8}, () => new Lastflat(url).submit(asset.id, {}, {fresh: true})));
const stop = new AbortController();
const hasty = new Lastflat(url, {
  fetch: async (input, init) => {
    const answer = await fetch(input, {...init, signal: undefined});
    if (!stop.signal.aborted) {
      stop.abort();
      throw stop.signal.reason;
    }
    return answer;
  },
});
await assert.rejects(hasty.flatten(asset.id, {tag: "hasty"}, {fresh: true, signal: stop.signal}), {name: "AbortError"});
const [hastened] = (await (await fetch(`${url}/v1/jobs?tag=hasty`)).json()).items;
assert.match(hastened.state, /^cancel/);

// What a proxy says: a date, and how long to wait.
let waits = [new Date(Date.now() + 1000).toUTCString(), "0", "soon"];
const busy = new Lastflat(url, {
  fetch: async (input, init) => (waits.length === 0 ? fetch(input, init)
    : new Response("busy", {status: 503, headers: {"Retry-After": waits.shift()}})),
});
assert.equal((await busy.job(hastened.id)).id, hastened.id);
await assert.rejects(new Lastflat(url).job("0f8fad5b-d9cb-469f-a165-70867728950f"), LastflatError);
console.log(`${asked.length} requests on a bad line`);
