#!/usr/bin/env node
// Uploads a last once, follows the job, asks again with one lock more, and puts the pattern on the model itself.
//
//   flatten.js LAST.glb [REQUEST] [CURVE]     CURVE: of the request, locked the second time; default: its first
//
// LASTFLAT_URL, LASTFLAT_KEY: the server and its key. Writes result.json, and textured.json: the model's triangles with
// the pattern as texture coordinates, as a geometry for THREE.BufferGeometryLoader.
import {readFile, writeFile} from "node:fs/promises";
import process from "node:process";
import * as THREE from "three";
import {GLTFLoader} from "three/addons/loaders/GLTFLoader.js";
import {Lastflat, LastflatError} from "./lastflat.js";
import {modelOf, textured, toBufferGeometry} from "./texture.js";

const [last, request, curve] = process.argv.slice(2);

/** @param {import("./lastflat.js").FlattenResult} result */
function print(result) {
  for (const region of result.regions) {
    for (const {name, length_3d_mm, error_mm, verdict} of region.curves) {
      console.log(`${region.name} ${name}: ${length_3d_mm.toFixed(3)} mm on the last, flat - last ${error_mm.toFixed(6)} mm`,
                  verdict ?? "(free)");
    }
  }
}

async function main() {
  if (!last) throw new Error("usage: flatten.js LAST.glb [REQUEST] [CURVE]");
  const service = new Lastflat(process.env.LASTFLAT_URL ?? "http://127.0.0.1:8080", {key: process.env.LASTFLAT_KEY});
  const bytes = new Uint8Array(await readFile(last));
  const constraints = request ? JSON.parse(await readFile(request, "utf8")) : {};

  const asset = await service.upload(bytes);
  const onProgress = (/** @type {import("./lastflat.js").Progress} */ p) => console.error(`${p.stage} ${p.percent} %`);
  const job = await service.flatten(asset.id, constraints, {onProgress});
  print(await service.result(job.id));

  const extra = curve ?? Object.keys(constraints.curves ?? {})[0];
  const locks = [...(constraints.locks ?? []).filter((/** @type {any} */ lock) => lock.curve !== extra)];
  if (extra) locks.push({curve: extra, keep: "total"});
  console.log(extra ? `and the length of ${extra} kept as a whole:` : "and again:");
  const second = await service.flatten(asset.id, {...constraints, locks}, {onProgress});
  const result = await service.result(second.id);
  print(result);
  await writeFile("result.json", JSON.stringify(result));

  const gltf = await new GLTFLoader().parseAsync(bytes.buffer, "");
  const geometry = toBufferGeometry(THREE, textured(result, modelOf(gltf)));
  await writeFile("textured.json", JSON.stringify(geometry.toJSON()));
  console.log(`${geometry.attributes.position.count / 3} triangles of the model have their place on the pattern`);
}

main().catch((error) => {
  console.error(`flatten.js: ${error.message}`);
  process.exitCode = error instanceof LastflatError && error.problem.status < 500 ? 2 : 1;
});
