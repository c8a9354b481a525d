// The model's own triangles with their places on the pattern as texture coordinates.

/** @typedef {import("./lastflat.js").FlattenResult} FlattenResult */
/** @typedef {import("./lastflat.js").RegionResult} RegionResult */

/**
 * A model as the result counts it: corners are ids of vertices, in the order of `ModelIds` of /openapi.json.
 * @typedef {{positions: number[][], triangles: number[][]}} Model
 *
 * Three corners for each triangle. `uv`: 0..1 of the sheet, v down as glTF has it; `source`: per triangle, which of the
 * model it is, or is a part of; `regions`: which triangles belong to which piece.
 * @typedef {{positions: Float32Array, uv: Float32Array, source: Uint32Array,
 *   regions: {name: string, first: number, count: number}[]}} Textured
 */

/**
 * The model that three.js' GLTFLoader has loaded. Positions are those of the scene, in its unit. (Not of strips and fans
 * that repeat a vertex: the loader makes triangles of them that the result does not count.)
 * @param {any} gltf what the loader gives
 * @returns {Model}
 */
export function modelOf({scene, parser}) {
  /** @type {Model} */
  const model = {positions: [], triangles: []};
  /** @type {unknown} */
  let node;  // whose primitives may share vertices
  /** @type {{of: unknown[], base: number}[]} */
  let known = [];
  scene.updateMatrixWorld(true);
  scene.traverse((/** @type {any} */ object) => {
    if (!object.isMesh && !object.isLine) return;
    const {geometry, matrixWorld} = object;
    const {position} = geometry.attributes;
    const owner = parser.associations.get(object)?.nodes === undefined ? object.parent : object;
    if (owner !== node) [node, known] = [owner, []];
    const of = verticesOf(geometry);
    let base = known.find((other) => same(other.of, of))?.base;
    if (base === undefined) {
      base = model.positions.length;
      known.push({of, base});
      const point = object.position.clone();
      for (let v = 0; v < position.count; ++v) {
        // Morph targets and skins move what is drawn.
        if (object.isMesh) object.getVertexPosition(v, point);
        else point.fromBufferAttribute(position, v);
        model.positions.push(point.applyMatrix4(matrixWorld).toArray());
      }
    }
    if (object.isLine) return;
    const corners = geometry.index?.array ?? Array.from({length: position.count}, (_, v) => v);
    for (let c = 0; c + 3 <= corners.length; c += 3) {
      model.triangles.push([base + corners[c], base + corners[c + 1], base + corners[c + 2]]);
    }
  });
  return model;
}

/**
 * What vertices are made of: primitives that have all of it in common have them in common.
 * @param {any} geometry
 * @returns {unknown[]}
 */
function verticesOf({attributes, morphAttributes}) {
  return [attributes.position, attributes.skinIndex, attributes.skinWeight, ...(morphAttributes.position ?? [])];
}

/**
 * @param {unknown[]} a
 * @param {unknown[]} b
 */
function same(a, b) {
  return a.length === b.length && a.every((value, i) => value === b[i]);
}

/**
 * Every flat triangle where it lies on the model.
 * @param {FlattenResult} result
 * @param {Model} model
 * @returns {Textured}
 */
export function textured(result, model) {
  if (model.positions.length !== result.model.vertices || model.triangles.length !== result.model.triangles) {
    throw new Error("this is not the model that was flattened");
  }
  const positions = [], uv = [], source = [], regions = [];
  for (const region of result.regions) {
    const places = onSheet(region, result.layout);
    const made = new Map(region.source_points.map((point) => [point.vertex, point]));
    const first = source.length;
    for (const [t, corners] of region.triangles.entries()) {
      const s = region.source_triangles[t];
      if (s == null) continue;  // it fills a hole of the model
      for (const corner of corners) {
        const vertex = /** @type {number} */ (region.source_vertices[corner]);
        const point = made.get(corner);
        positions.push(...(point ? between(model, point) : model.positions[ownCorner(result, model.triangles[s], vertex)]));
        uv.push(...places[corner]);
      }
      source.push(s);
    }
    regions.push({name: region.name, first, count: source.length - first});
  }
  return {positions: new Float32Array(positions), uv: new Float32Array(uv), source: new Uint32Array(source), regions};
}

/**
 * Where a vertex lies that a curve made.
 * @param {Model} model
 * @param {{triangle: number[], weights: number[]}} point
 */
function between(model, {triangle, weights}) {
  return [0, 1, 2].map((k) => weights.reduce((sum, weight, i) => sum + weight * model.positions[triangle[i]][k], 0));
}

/**
 * The corner of a triangle of the model that is welded to the vertex; else the vertex itself.
 * @param {FlattenResult} result
 * @param {number[]} triangle
 * @param {number} vertex
 */
function ownCorner(result, triangle, vertex) {
  const weld = result.model.welded_to;
  return triangle.find((corner) => (weld.length > 0 ? weld[corner] : corner) === vertex) ?? vertex;
}

/**
 * The piece's points as shares of the sheet, v down.
 * @param {RegionResult} region
 * @param {FlattenResult["layout"]} sheet
 * @returns {[number, number][]}
 */
function onSheet(region, sheet) {
  const placement = sheet.placements.find((candidate) => candidate.region === region.name);
  if (!placement) throw new Error(`'${region.name}' has no place on the sheet`);
  const angle = (placement.rotation_deg * Math.PI) / 180;
  const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
  const [dx, dy] = placement.translation_mm;
  return region.uv_mm.map(([x, upward]) => {
    const y = placement.mirrored ? -upward : upward;
    return [share((cos * x - sin * y + dx) / sheet.width_mm), 1 - share((sin * x + cos * y + dy) / sheet.height_mm)];
  });
}

/** @param {number} value What lies on the sheet's edge may be beyond it by a rounding. */
function share(value) {
  return Math.min(Math.max(value, 0), 1);
}

/**
 * A geometry for three.js, a group for each piece.
 * @param {any} THREE the module
 * @param {Textured} textured
 */
export function toBufferGeometry(THREE, {positions, uv, regions}) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
  geometry.setAttribute("uv", new THREE.BufferAttribute(uv, 2));
  for (const [i, {first, count}] of regions.entries()) geometry.addGroup(3 * first, 3 * count, i);
  geometry.computeVertexNormals();
  return geometry;
}
