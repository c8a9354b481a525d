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
export function modelOf({ scene, parser }: any): Model;
/**
 * Every flat triangle where it lies on the model.
 * @param {FlattenResult} result
 * @param {Model} model
 * @returns {Textured}
 */
export function textured(result: FlattenResult, model: Model): Textured;
/**
 * A geometry for three.js, a group for each piece.
 * @param {any} THREE the module
 * @param {Textured} textured
 */
export function toBufferGeometry(THREE: any, { positions, uv, regions }: Textured): any;
export type FlattenResult = import("./lastflat.js").FlattenResult;
export type RegionResult = import("./lastflat.js").RegionResult;
/**
 * Three corners for each triangle. `uv`: 0..1 of the sheet, v down as glTF has it; `source`: per triangle, which of the
 * model it is, or is a part of; `regions`: which triangles belong to which piece.
 */
export type Model = {
    positions: number[][];
    triangles: number[][];
};
/**
 * A model as the result counts it: corners are ids of vertices, in the order of `ModelIds` of /openapi.json.
 */
export type Textured = {
    positions: Float32Array;
    uv: Float32Array;
    source: Uint32Array;
    regions: {
        name: string;
        first: number;
        count: number;
    }[];
};
