#include "core/constrain/check_constraints.h"

#include <algorithm>

#include "core/constrain/pins.h"

namespace lastflat {
namespace {

[[noreturn]] void refuse(const Constraint& constraint, const char* field, const std::string& what) {
    auto option = constraint.option;
    option.emplace_back(field);
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
    if (count == 0) refuse(pin, "vertex", "no region has this vertex");
    if (count > 1) {
        refuse(pin, "region",
               "the vertex lies on a cut and is in " + std::to_string(count) +
                   " places of the pattern; name the region, and pin a vertex that it has once");
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
        if (constraint.kind == ConstraintKind::pin) check_pin(constraint, regions);
    }
}

}  // namespace lastflat
