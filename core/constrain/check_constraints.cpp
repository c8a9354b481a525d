#include "core/constrain/check_constraints.h"

#include <algorithm>

#include "core/constrain/pins.h"

namespace lastflat {
namespace {

[[noreturn]] void refuse(const Constraint& constraint, const char* field, const std::string& what) {
    auto option = constraint.option;
    if (field != nullptr) option.emplace_back(field);
    throw Error(ErrorCode::curve_invalid, title(constraint) + ": " + what).at_option(option);
}

/// What a kind of constraint names must be there; one overload for each kind.
class NameCheck {
public:
    NameCheck(const Constraint& constraint, const Curves& curves,
              const std::vector<Region>& regions)
        : constraint_(constraint), curves_(curves), regions_(regions) {}

    void operator()(const Lock& lock) const { check_line(lock); }
    void operator()(const Range& range) const { check_line(range); }
    void operator()(const Straight& straight) const {
        check_line(straight);
        const bool closed = std::any_of(curves_.begin(), curves_.end(), [&](const Curve& curve) {
            return curve.name == straight.curve && curve.closed();
        });
        if (closed) refuse(constraint_, "curve", "a closed curve cannot lie on a line");
    }
    void operator()(const Match& match) const {
        check_curve("curve", match.curve);
        check_curve("with_curve", match.with_curve);
        check_region("region", match.region);
        check_region("with_region", match.with_region);
        check_runs("region", match.curve, match.region);
        check_runs("with_region", match.with_curve, match.with_region);
    }
    void operator()(const TotalArea& area) const { check_region("region", area.region); }
    void operator()(const Pin& pin) const {
        check_region("region", pin.region);
        std::size_t count = 0;
        for (const Region& region : regions_) count += pinned_vertices(region, pin).size();
        if (count == 0) refuse(constraint_, nullptr, "no region has this vertex");
        if (count > 1) {
            refuse(
                constraint_, nullptr,
                "the vertex lies on a cut and is in " + std::to_string(count) +
                    " places of the pattern; name the region, and pin a vertex that it has once");
        }
    }
    void operator()(const Seam& seam) const { check_curve("curve", seam.curve); }

private:
    template <class OfCurve>
    void check_line(const OfCurve& demand) const {
        check_curve("curve", demand.curve);
        check_region("region", demand.region);
        check_runs("region", demand.curve, demand.region);
    }

    void check_curve(const char* field, const std::string& curve) const {
        check_name(field, curve, "curve", curves_);
    }

    void check_region(const char* field, const std::string& region) const {
        check_name(field, region, "region", regions_);
    }

    template <class Named>
    void check_name(const char* field, const std::string& wanted, const char* kind,
                    const std::vector<Named>& known) const {
        const bool found = std::any_of(known.begin(), known.end(),
                                       [&](const Named& one) { return one.name == wanted; });
        if (wanted.empty() || found) return;
        std::string names;
        for (const Named& one : known) names += (names.empty() ? "" : ", ") + one.name;
        refuse(constraint_, field,
               std::string("there is no ") + kind + " '" + wanted + "'; there are: " + names);
    }

    void check_runs(const char* field, const std::string& curve, const std::string& region) const {
        if (curve.empty() || region.empty()) return;
        for (const Region& r : regions_) {
            const bool runs = std::any_of(r.runs.begin(), r.runs.end(),
                                          [&](const CurveRun& run) { return run.curve == curve; });
            if (r.name != region || runs) continue;
            std::string what = "the curve '" + curve;
            what += "' does not run through the region '" + region + "'";
            refuse(constraint_, field, what);
        }
    }

    const Constraint& constraint_;
    const Curves& curves_;
    const std::vector<Region>& regions_;
};

}  // namespace

void check_constraints(const std::vector<Constraint>& constraints, const Curves& curves,
                       const std::vector<Region>& regions) {
    for (const Constraint& constraint : constraints)
        std::visit(NameCheck(constraint, curves, regions), constraint.demand);
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
