#include "core/constrain/constraint.h"

#include <algorithm>
#include <set>

namespace lastflat {
namespace {

struct Namer {
    std::string_view operator()(const Lock&) const { return "lock"; }
    std::string_view operator()(const Range&) const { return "range"; }
    std::string_view operator()(const Match&) const { return "match"; }
    std::string_view operator()(const Straight&) const { return "straight"; }
    std::string_view operator()(const TotalArea&) const { return "total_area"; }
    std::string_view operator()(const Pin&) const { return "pin"; }
    std::string_view operator()(const Seam&) const { return "seam"; }
};

std::string in(const std::string& region) {
    return region.empty() ? "" : " in " + region;
}

struct Titler {
    std::string operator()(const Lock& c) const { return "lock of " + c.curve + in(c.region); }
    std::string operator()(const Range& c) const { return "range of " + c.curve + in(c.region); }
    std::string operator()(const Match& c) const {
        return "match of " + c.curve + in(c.region) + " with " + c.with_curve;
    }
    std::string operator()(const Straight& c) const { return "straight " + c.curve + in(c.region); }
    std::string operator()(const TotalArea& c) const {
        return c.region.empty() ? "total area" : "total area of " + c.region;
    }
    std::string operator()(const Pin& c) const {
        return "pin of vertex " + std::to_string(c.vertex) + in(c.region);
    }
    std::string operator()(const Seam& c) const { return "seam along " + c.curve; }
};

}  // namespace

std::string_view name(const Constraint& constraint) {
    return std::visit(Namer{}, constraint.demand);
}

std::string title(const Constraint& constraint) {
    return std::visit(Titler{}, constraint.demand);
}

bool binds(const std::string& wanted, const Region& region) {
    return wanted.empty() || wanted == region.name;
}

std::vector<const CurveRun*> runs_locked_by_edges(const Region& region,
                                                  const std::vector<Constraint>& constraints) {
    const auto is_locked = [&](const CurveRun& run) {
        return std::any_of(constraints.begin(), constraints.end(), [&](const Constraint& c) {
            const Lock* lock = std::get_if<Lock>(&c.demand);
            return lock != nullptr && lock->keep == Keep::edges && lock->curve == run.curve &&
                   binds(lock->region, region);
        });
    };
    std::vector<const CurveRun*> locked;
    for (const CurveRun& run : region.runs) {
        if (is_locked(run)) locked.push_back(&run);
    }
    return locked;
}

std::vector<bool> locked_border_edges(const Region& region,
                                      const std::vector<Constraint>& constraints) {
    std::set<std::pair<Index, Index>> kept;
    for (const CurveRun* run : runs_locked_by_edges(region, constraints)) {
        for (std::size_t i = 1; i < run->vertices.size(); ++i)
            kept.insert(std::minmax(run->vertices[i - 1], run->vertices[i]));
    }
    const std::size_t n = region.border.size();
    std::vector<bool> locked(n);
    for (std::size_t i = 0; i < n; ++i) {
        locked[i] = kept.count(std::minmax(region.border[i], region.border[(i + 1) % n])) > 0;
    }
    return locked;
}

}  // namespace lastflat
