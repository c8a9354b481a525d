// What the shoe-maker asks of a pattern, in his words.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/cut/region.h"

namespace lastflat {

enum class ConstraintKind {
    lock,        ///< a curve keeps its length
    range,       ///< a curve's length stays between two shares of its own
    match,       ///< a curve becomes as long as another, in the same region or not
    straight,    ///< a curve lies on a line: a vamp cut on the fold
    total_area,  ///< a region keeps its area, or stays between two shares of it
    pin,         ///< a point lies at a given place of the plane
    seam,        ///< both sides of a cut become equally long, stretch by stretch
};

enum class Keep {
    edges,  ///< every edge of the curve keeps its 3D length
    total,  ///< their sum does
};

/// One request; which fields count depends on the kind. A curve that runs through several regions
/// is constrained in each, unless `region` names one.
struct Constraint {
    ConstraintKind kind = ConstraintKind::lock;
    std::string curve{};
    Keep keep = Keep::edges;                      ///< lock
    double min_percent = 0.0, max_percent = 0.0;  ///< range, total_area: -1 is one per cent less
    std::string region{};                         ///< empty: every one (not for pin)
    std::string with_curve{}, with_region{};      ///< match
    Index vertex = -1;                            ///< pin: id of the file
    Vec2 place = Vec2::Zero();                    ///< pin: mm
    int priority = 0;                             ///< the least important gives way first
    std::vector<std::string> option{};            ///< where it stands in the request

    /// "lock of heel", "range of topline", "total area of lateral": for people.
    [[nodiscard]] std::string title() const;
};

[[nodiscard]] std::string_view name(ConstraintKind kind);

/// A curve that keeps the length of every edge, or in total.
[[nodiscard]] Constraint lock(std::string curve, Keep keep = Keep::edges);

/// A cut whose sides are sewn together.
[[nodiscard]] Constraint seam(std::string curve);

/// Per border edge, whether a lock of kind `edges` holds it.
[[nodiscard]] std::vector<bool> locked_border_edges(const Region& region,
                                                    const std::vector<Constraint>& constraints);

}  // namespace lastflat
