#include "core/constrain/check_constraints.h"

#include <algorithm>

#include "core/constrain/pins.h"

namespace lastflat {
namespace {

[[noreturn]] void refuse(const Constraint& constraint, const char* field, const std::string& what) {
    auto option = constraint.option;
    if (field != nullptr) option.emplace_back(field);
    throw Error(ErrorCode::curve_invalid, constraint.title() + ": " + what).at_option(option);
}

std::string listed(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

void check_name(const Constraint& constraint, const char* field, const std::string& name,
                const char* kind, const std::vector<std::string>& known) {
    if (name.empty() || std::find(known.begin(), known.end(), name) != known.end()) return;
    refuse(constraint, field,
           std::string("there is no ") + kind + " '" + name + "'; there are: " + listed(known));
}

void check_pin(const Constraint& pin, const std::vector<Region>& regions) {
    std::size_t count = 0;
    for (const Region& region : regions) count += pinned_vertices(region, {pin}).size();
    if (count == 0) refuse(pin, nullptr, "no region has this vertex");
    if (count > 1) {
        refuse(pin, nullptr,
               "the vertex lies on a cut and is in " + std::to_string(count) +
                   " places of the pattern; name the region, and pin a vertex that it has once");
    }
}

void check_runs(const Constraint& constraint, const char* field, const std::string& curve,
                const std::string& region, const std::vector<Region>& regions) {
    if (curve.empty() || region.empty()) return;
    for (const Region& r : regions) {
        if (r.name != region) continue;
        const bool runs = std::any_of(r.runs.begin(), r.runs.end(),
                                      [&](const CurveRun& run) { return run.curve == curve; });
        if (!runs) {
            std::string what = "the curve '" + curve;
            what += "' does not run through the region '" + region + "'";
            refuse(constraint, field, what);
        }
    }
}

}  // namespace

void check_constraints(const std::vector<Constraint>& constraints, const Curves& curves,
                       const std::vector<Region>& regions) {
    std::vector<std::string> curve_names, region_names;
    for (const Curve& curve : curves) curve_names.push_back(curve.name);
    for (const Region& region : regions) region_names.push_back(region.name);
    for (const Constraint& constraint : constraints) {
        check_name(constraint, "curve", constraint.curve, "curve", curve_names);
        check_name(constraint, "with_curve", constraint.with_curve, "curve", curve_names);
        check_name(constraint, "region", constraint.region, "region", region_names);
        check_name(constraint, "with_region", constraint.with_region, "region", region_names);
        check_runs(constraint, "region", constraint.curve, constraint.region, regions);
        check_runs(constraint, "with_region", constraint.with_curve, constraint.with_region,
                   regions);
        if (constraint.kind == ConstraintKind::pin) check_pin(constraint, regions);
        const bool closed = std::any_of(curves.begin(), curves.end(), [&](const Curve& curve) {
            return curve.name == constraint.curve && curve.closed();
        });
        if (constraint.kind == ConstraintKind::straight && closed)
            refuse(constraint, "curve", "a closed curve cannot lie on a line");
    }
}

void check_zones(const std::vector<Zone>& zones, const Curves& curves,
                 const std::vector<Region>& regions) {
    const auto is_somewhere = [&](Index vertex) {
        return std::any_of(regions.begin(), regions.end(), [&](const Region& region) {
            return std::find(region.source_vertices.begin(), region.source_vertices.end(),
                             vertex) != region.source_vertices.end();
        });
    };
    for (std::size_t i = 0; i < zones.size(); ++i) {
        const Zone& zone = zones[i];
        const auto refuse_zone = [&](const char* field, const std::string& what) {
            throw Error(ErrorCode::curve_invalid, "zone " + std::to_string(i) + ": " + what)
                .at_option({"weights", "zones", std::to_string(i), field});
        };
        const bool known =
            zone.curve.empty() || std::any_of(curves.begin(), curves.end(),
                                              [&](const Curve& c) { return c.name == zone.curve; });
        if (!known) refuse_zone("curve", "there is no curve '" + zone.curve + "'");
        if (zone.vertex >= 0 && !is_somewhere(zone.vertex))
            refuse_zone("vertex", "no region has the vertex " + std::to_string(zone.vertex));
        if (!zone.vertices.empty() &&
            std::none_of(zone.vertices.begin(), zone.vertices.end(), is_somewhere))
            refuse_zone("vertices", "no region has any of them");
    }
}

}  // namespace lastflat
