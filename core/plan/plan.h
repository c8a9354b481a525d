// What will be done with a surface.
#pragma once

#include <optional>

#include "core/landmarks/landmarks.h"
#include "core/progress.h"
#include "core/request.h"
#include "core/weld/surface_mesh.h"

namespace lastflat {

/// A request that leaves nothing open. Run as a request on the same model, it gives the same
/// pattern.
struct Plan {
    /// Its curves are in the order in which they are located; vertices of constraints and zones are
    /// those that stand for them on the surface.
    Request request;
    /// Of a bare last; its curves and cut stand in the request.
    std::optional<Landmarks> landmarks{};
    /// How many of the curves, cuts and regions were found, not asked for by name.
    enum class Found { none, some, all } found = Found::none;
};

/// It alone decides. For a request that says nothing of cuts, seams, regions or groups
/// of a closed last, what it would have said is found (see `find_landmarks`). Curves that it does
/// name stand in for those that would be found; without constraints the centre line is locked.
///
/// Throws: Error as `find_landmarks`.
[[nodiscard]] Plan make_plan(const SurfaceMesh& surface, const Request& request,
                             const Progress& progress = Progress(), std::size_t threads = 1);

/// Whether a plan of it needs landmarks.
[[nodiscard]] bool is_bare(const SurfaceMesh& surface, const Request& request);

/// The same with landmarks that are known, if it is bare.
[[nodiscard]] Plan make_plan(const SurfaceMesh& surface, const Request& request,
                             std::optional<Landmarks> found);

}  // namespace lastflat
