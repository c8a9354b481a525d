// Faces that are no part of any surface.
#pragma once

#include "core/weld/face_origin.h"
#include "core/weld/repair.h"
#include "core/weld/sides.h"

namespace lastflat {

/// Triangles while they are mended. `welded_to[v]` stands for vertex v. The last vertices are
/// copies of others. Not for several threads.
struct Faces {
    struct Known {
        std::vector<Triangle> triangles;
        std::vector<Side> sides;
    };
    Points3 positions;
    std::vector<Triangle> triangles;
    std::vector<FaceOrigin> origins;  ///< per triangle
    std::vector<Index> welded_to;
    std::vector<Index> copies{};  ///< per copy, whose
    mutable Known known{};        ///< for `sides`

    [[nodiscard]] const Vec3& position(Index vertex) const {
        return positions[static_cast<std::size_t>(vertex)];
    }
    /// `sides_by_edge` of the triangles as they are; valid until they change.
    [[nodiscard]] const std::vector<Side>& sides() const;
    /// Renames the triangles' vertices after `welded_to` has changed.
    void rename();
    /// Keeps the triangles for which it is true.
    template <class Keep>
    void keep_if(const Keep& keep) {
        std::size_t kept = 0;
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            if (!keep(triangles[t])) continue;
            triangles[kept] = triangles[t];
            origins[kept++] = origins[t];
        }
        triangles.resize(kept);
        origins.resize(kept);
    }
};

/// The diagonal of the triangles' box.
[[nodiscard]] double size_of(const Faces& faces);

/// Drops triangles that name a vertex twice and repetitions of a triangle.
void drop_repeated_faces(Faces& faces, std::vector<Repair>& repairs);

/// The same; and flat triangles are taken out so that no hole stays: where an edge is nearly zero
/// its ends become one vertex, else the vertex that lies on the longest side is put into that side.
void clean_faces(Faces& faces, std::vector<Repair>& repairs);

/// Turns patches, each of triangles that wind alike, until those beside each other wind alike, as
/// the greater part of each connected piece does. Within a patch nothing is turned: a surface that
/// has no two sides stays as it is.
void wind_alike(Faces& faces, std::vector<Repair>& repairs);

/// Drops pieces that neither share a vertex with the rest nor come near to its border with their
/// own
/// (`tolerance::near_border`) and have less than `tolerance::stray_area` of the largest one's area.
void drop_strays(Faces& faces, std::vector<Repair>& repairs);

}  // namespace lastflat
