// A flat-shaded model gets the pattern as its texture: node built/texture.js URL LAST.glb
import {readFileSync} from "node:fs";
import assert from "node:assert/strict";
import * as THREE from "three";
import {GLTFLoader} from "three/addons/loaders/GLTFLoader.js";
import {Lastflat, type FlattenRequest, type FlattenResult, type Job} from "./javascript/lastflat.js";
import {modelOf, textured, toBufferGeometry, type Model} from "./javascript/texture.js";
import type {components} from "./schema.js";

// What the module calls a job, a result, a request fits the contract.
type Schemas = components["schemas"];
export const fits = (job: Schemas["Job"], result: Schemas["FlattenResult"], request: Schemas["FlattenRequest"]):
  [Job, FlattenResult, FlattenRequest] => [job, result, {...request}];

const [url, last] = process.argv.slice(2);
assert(url && last, "usage: texture.js URL LAST.glb");

type Point = [number, number, number];
const load = (bytes: Uint8Array) => new GLTFLoader().parseAsync(new Uint8Array(bytes).buffer, "");

/** Three vertices for each triangle; every other triangle in a node that hangs, moved and turned, below the first. */
function flatShaded(model: Model): Uint8Array<ArrayBuffer> {
  const halves = [0, 1].map((half) => model.triangles.filter((_, t) => t % 2 === half)
    .flatMap((corners) => corners.map((v) => model.positions[v] as Point)));
  const moved = halves[1]!.map(([x, y, z]): Point => [y - 0.5, -x, z]);  // undone by the node
  const buffers = [halves[0]!, moved].map((points) => new Float32Array(points.flat()));
  const bounds = [halves[0]!, moved].map((points) => [0, 1, 2].map((k) => points.map((p) => p[k]!)).map(
    (values) => [values.reduce((a, b) => Math.min(a, b)), values.reduce((a, b) => Math.max(a, b))]));
  const bytes = buffers.map((buffer) => buffer.byteLength);
  const json = JSON.stringify({
    asset: {version: "2.0"}, scene: 0, scenes: [{nodes: [1]}],
    nodes: [{mesh: 1, translation: [0, 0.5, 0], rotation: [0, 0, Math.SQRT1_2, Math.SQRT1_2]},
            {mesh: 0, children: [0], extras: {}}],
    meshes: [0, 1].map((i) => ({primitives: [{attributes: {POSITION: i}}]})),
    accessors: [0, 1].map((i) => ({bufferView: i, componentType: 5126, type: "VEC3", count: bytes[i]! / 12,
      min: bounds[i]!.map(([low]) => Math.fround(low!)), max: bounds[i]!.map(([, high]) => Math.fround(high!))})),
    bufferViews: [0, 1].map((i) => ({buffer: 0, byteOffset: i * bytes[0]!, byteLength: bytes[i]})),
    buffers: [{byteLength: bytes[0]! + bytes[1]!}],
  });
  const head = Buffer.from(json.padEnd(Math.ceil(json.length / 4) * 4));
  const body = Buffer.concat(buffers.map((buffer) => Buffer.from(buffer.buffer)));
  const words = Uint32Array.of(0x46546C67, 2, 28 + head.length + body.length, head.length, 0x4E4F534A);
  return new Uint8Array(Buffer.concat([Buffer.from(words.buffer), head, Buffer.from(Uint32Array.of(body.length, 0x004E4942).buffer), body]));
}

const areaOf = (corners: THREE.Vector3[]) => new THREE.Triangle(...(corners as [THREE.Vector3, THREE.Vector3, THREE.Vector3])).getArea();

async function check(bytes: Uint8Array<ArrayBuffer>, model: Model, request: FlattenRequest): Promise<FlattenResult> {
  const service = new Lastflat(url!);
  const asset = await service.upload(bytes);
  const stages = new Set<string>();
  const job = await service.flatten(asset.id, request, {onProgress: ({stage}) => stages.add(stage)});
  assert.equal(job.state, "succeeded");
  assert(stages.size > 0);
  const result = await service.result(job.id);
  const texture = textured(result, model);
  const geometry = toBufferGeometry(THREE, texture);
  const at = (corner: number) => new THREE.Vector3().fromBufferAttribute(geometry.attributes.position as THREE.BufferAttribute, corner);
  const [width, height] = [result.layout.width_mm, result.layout.height_mm];
  const flat = (corner: number) => new THREE.Vector3(texture.uv[2 * corner]! * width, texture.uv[2 * corner + 1]! * height, 0);

  // Each triangle of the model that has a part in the pattern is covered by its parts, and each of its corners has a place.
  const covered = new Map<number, number>();
  const parts = new Map<number, number>();
  const placed = new Set<string>();
  let on_model = 0, in_flat = 0;
  for (const [t, source] of texture.source.entries()) {
    const corners = [3 * t, 3 * t + 1, 3 * t + 2];
    covered.set(source, (covered.get(source) ?? 0) + areaOf(corners.map(at)));
    parts.set(source, (parts.get(source) ?? 0) + 1);
    on_model += areaOf(corners.map(at));
    in_flat += areaOf(corners.map(flat));
    for (const corner of corners) {
      assert(texture.uv[2 * corner]! >= -1e-6 && texture.uv[2 * corner]! <= 1 + 1e-6);
      assert(texture.uv[2 * corner + 1]! >= -1e-6 && texture.uv[2 * corner + 1]! <= 1 + 1e-6);
      const own = model.triangles[source]!.findIndex((v) => at(corner).distanceTo(new THREE.Vector3(...(model.positions[v] as Point))) < 1e-9);
      if (own >= 0) placed.add(`${source} ${own}`);
    }
  }
  for (const [source, area] of covered) {
    const whole = areaOf(model.triangles[source]!.map((v) => new THREE.Vector3(...(model.positions[v] as Point))));
    assert(Math.abs(area - whole) <= 1e-3 * whole, `triangle ${source}: ${area} of ${whole}`);
    for (const k of [0, 1, 2]) assert(placed.has(`${source} ${k}`), `corner ${k} of triangle ${source} has no place`);
  }
  assert(Math.abs(in_flat / (1e6 * on_model) - 1) < 0.02, "the flat area in mm2 is that of the model in m2");
  console.log(covered.size, "triangles,", [...parts.values()].filter((count) => count > 1).length, "of them in parts");
  return result;
}

const bytes = new Uint8Array(readFileSync(last));
const smooth = modelOf(await load(bytes));
const request = JSON.parse(readFileSync(last.replace(/\.glb$/, ".request.json"), "utf8"));
const indexed = await check(bytes, smooth, {...request, units: "m"});
assert.equal(indexed.model.welded_to.length, 0);
assert(indexed.model.seam_vertices.length > 60);  // centre line and heel
for (const {source_vertex, places} of indexed.model.seam_vertices) {
  for (const {region, vertex} of places) {
    assert.equal(indexed.regions.find(({name}) => name === region)!.source_vertices[vertex], source_vertex);
  }
}

const flat = flatShaded(smooth);
const model = modelOf(await load(flat));
const result = await check(flat, model, {});
assert.equal(result.model.welded_to.length, 3 * model.triangles.length);
