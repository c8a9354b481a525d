// A client made of the contract alone, run against the service: node built/client.js URL LAST REQUEST
import {readFileSync} from "node:fs";
import assert from "node:assert/strict";
import createClient from "openapi-fetch";
import type {components, paths} from "./schema.js";

type Result = components["schemas"]["FlattenResult"];
type Position = components["schemas"]["Position"];

const [baseUrl, last, constraints] = process.argv.slice(2);
assert(baseUrl && last && constraints, "usage: client.js URL LAST REQUEST");
const client = createClient<paths>({baseUrl});
const request = JSON.parse(readFileSync(constraints, "utf8")) as components["schemas"]["FlattenRequest"];

/** What a form carries. */
function form(fields: Record<string, Blob | string>): FormData {
  const data = new FormData();
  for (const [name, value] of Object.entries(fields)) data.append(name, value);
  return data;
}

async function flattenForm(): Promise<string> {
  const {data, error, response} = await client.POST("/v1/jobs", {
    params: {header: {Prefer: "wait=60"}},
    body: {model: new Blob([readFileSync(last!)]), request},
    bodySerializer: (body) => form({model: (body as {model: Blob}).model, request: JSON.stringify(request)}),
  });
  assert(data, error?.detail);
  assert.equal(response.status, 200);
  return data.id;
}

async function resultOf(id: string): Promise<Result> {
  const {data, error} = await client.GET("/v1/jobs/{id}/result", {params: {path: {id}}});
  assert(data && typeof data !== "string", error?.detail);
  return data;
}

const id = await flattenForm();
const result = await resultOf(id);
for (const region of result.regions) {
  const [u, v] = region.uv_mm[0]!;
  const [a, b, c] = region.triangles[0]!;
  assert([u, v, a, b, c].every(Number.isFinite));
  for (const curve of region.curves) console.log(region.name, curve.name, curve.length_2d_mm.toFixed(3), curve.verdict ?? "-");
}
const toe: Position = [0, 0, 0];
assert.equal(toe.length, 3);

const asset = await client.POST("/v1/assets", {
  body: new Blob([readFileSync(last)]) as never,
  bodySerializer: (body: unknown) => body as Blob,
  headers: {"Content-Type": "application/octet-stream"},
});
assert(asset.data, asset.error?.detail);
const batch = await client.POST("/v1/jobs:batch", {
  params: {header: {Prefer: "wait=60"}},
  body: {jobs: ["a", "b"].map((tag) => ({model: {asset_id: asset.data.id}, request: {...request, tag}}))},
});
assert(batch.data?.finished, batch.error?.detail);
assert.deepEqual(batch.data.states, {succeeded: 2});

const broken = await client.POST("/v1/jobs", {body: {model: {data: "AA"}, request: {units: "ell" as "mm"}}});
assert.equal(broken.error?.code, "invalid_request");
assert.equal(broken.error.pointer, "/request/units");
const none = await client.GET("/v1/jobs/{id}", {params: {path: {id: "01M818EZFT08H3ZKBCZV6HRD97"}}});
assert.equal(none.error?.code, "job_not_found");
