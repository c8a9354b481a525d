// What a model file says, before anyone asks whether it is a surface.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/numerics/types.h"

namespace lastflat {

/// Triangles as the file lists them. Vertex ids are 0-based in file order (glTF: primitives in
/// document order, one after the other); polygons are already split into triangles.
struct RawMesh {
    Points3 positions;                ///< in the model's own unit
    std::vector<Triangle> triangles;  ///< counter-clockwise seen from outside

    /// Every triangle carries one set of group names (OBJ: g, o, usemtl; glTF: node, mesh,
    /// material): `label_sets[triangle_labels[t]]`.
    std::vector<std::vector<std::string>> label_sets;
    std::vector<std::uint32_t> triangle_labels;

    /// Lines (OBJ: l; glTF: line primitives) with the names of their group, object or node.
    struct Line {
        std::vector<std::string> names;
        std::vector<Index> vertices;
    };
    std::vector<Line> lines;

    bool indexed = true;  ///< false: triangles do not share vertices (STL, unindexed glTF)
    /// Along a seam of texture or material a vertex stands more than once (glTF, PLY).
    bool repeats_at_seams = false;
    std::vector<Warning> warnings;
    double default_unit_mm = 1.0;  ///< the model's unit when the request does not say: glTF 1000
};

}  // namespace lastflat
