// The borders of faces that are mended.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "core/weld/clean_faces.h"

namespace lastflat {

/// A closed line of border vertices, as the border's edges run.
struct Loop {
    std::vector<Index> vertices;
    std::vector<double> along;  ///< per vertex, mm from the first
    double length = 0.0;

    [[nodiscard]] std::size_t size() const { return vertices.size(); }
    [[nodiscard]] Index vertex(std::size_t i) const { return vertices[i % vertices.size()]; }
};

[[nodiscard]] Loop loop_of(const Faces& faces, std::vector<Index> vertices);

/// All closed ones of more than two vertices; where loops meet in a vertex, some way through it.
[[nodiscard]] std::vector<Loop> border_loops(const Faces& faces);

/// Vertices that come between the ends of border edges, in their order.
using Insertions = std::map<std::pair<Index, Index>, std::vector<Index>>;

/// Splits the triangles at border edges; the vertices stay where they are.
void insert_into_edges(Faces& faces, const Insertions& insertions);

/// Vertices become others: the first of each pair the second.
void rename_vertices(Faces& faces, const std::map<Index, Index>& renamed);

}  // namespace lastflat
