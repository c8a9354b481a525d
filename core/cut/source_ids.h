// What the surface's vertices and triangles are in the model's file.
#pragma once

#include <optional>
#include <vector>

#include "core/locate/surface_point.h"

namespace lastflat {

/// A vertex of the surface has an id: those of the file come first, then copies of vertices where
/// the surface touched itself, then what curves made.
struct SourceIds {
    std::size_t vertices = 0, triangles = 0;  ///< of the file
    std::vector<Index> welded_to;  ///< per vertex of the file, the one that stands for it
    std::vector<Index> copies;     ///< of which vertex of the file
    /// What curves made, between vertices that were there before any curve.
    std::vector<SurfacePoint> added;

    SourceIds() = default;
    /// Of a surface into which curves have been put.
    SourceIds(const SurfaceMesh& surface, std::vector<SurfacePoint> added_by_curves);

    /// Nothing: a curve made it.
    [[nodiscard]] std::optional<Index> file_vertex(Index id) const;
    /// Of a vertex that a curve made: the vertices of the file between which it lies.
    [[nodiscard]] SurfacePoint made_at(Index id) const;

private:
    [[nodiscard]] Index of_file(Index id) const {
        return at(id) < vertices ? id : copies[at(id) - vertices];
    }
};

}  // namespace lastflat
