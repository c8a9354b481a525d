#include "core/constrain/constraint.h"

#include <algorithm>
#include <set>

namespace lastflat {

std::string_view name(ConstraintKind kind) {
    switch (kind) {
        case ConstraintKind::lock: return "lock";
        case ConstraintKind::range: return "range";
        case ConstraintKind::match: return "match";
        case ConstraintKind::straight: return "straight";
        case ConstraintKind::total_area: return "total_area";
        case ConstraintKind::pin: return "pin";
        case ConstraintKind::seam: return "seam";
    }
    return "unknown";
}

std::string Constraint::title() const {
    const std::string where =
        region.empty() || kind == ConstraintKind::total_area ? "" : " in " + region;
    switch (kind) {
        case ConstraintKind::lock: return "lock of " + curve + where;
        case ConstraintKind::range: return "range of " + curve + where;
        case ConstraintKind::match: return "match of " + curve + where + " with " + with_curve;
        case ConstraintKind::straight: return "straight " + curve + where;
        case ConstraintKind::total_area:
            return region.empty() ? "total area" : "total area of " + region;
        case ConstraintKind::pin: return "pin of vertex " + std::to_string(vertex) + where;
        case ConstraintKind::seam: return "seam along " + curve;
    }
    return {};
}

Constraint lock(std::string curve, Keep keep) {
    Constraint constraint;
    constraint.curve = std::move(curve);
    constraint.keep = keep;
    return constraint;
}

Constraint seam(std::string curve) {
    Constraint constraint;
    constraint.kind = ConstraintKind::seam;
    constraint.curve = std::move(curve);
    return constraint;
}

std::vector<bool> locked_border_edges(const Region& region,
                                      const std::vector<Constraint>& constraints) {
    std::set<std::pair<Index, Index>> kept;
    for (const Constraint& constraint : constraints) {
        if (constraint.kind != ConstraintKind::lock || constraint.keep != Keep::edges) continue;
        if (!constraint.region.empty() && constraint.region != region.name) continue;
        for (const CurveRun& run : region.runs) {
            if (run.curve != constraint.curve) continue;
            for (std::size_t i = 1; i < run.vertices.size(); ++i)
                kept.insert(std::minmax(run.vertices[i - 1], run.vertices[i]));
        }
    }
    const std::size_t n = region.border.size();
    std::vector<bool> locked(n);
    for (std::size_t i = 0; i < n; ++i) {
        locked[i] = kept.count(std::minmax(region.border[i], region.border[(i + 1) % n])) > 0;
    }
    return locked;
}

}  // namespace lastflat
