#include "core/session/change.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace lastflat {
namespace {

/// Results are measured along these, cut or not.
constexpr std::array<std::string_view, 6> meaningful{curve_name::centre_front, curve_name::toe,
                                                     curve_name::instep,       curve_name::heel,
                                                     curve_name::featherline,  curve_name::topline};

bool is_named(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

bool concerns(const Lock& lock, const std::string& curve) {
    return lock.curve == curve;
}
bool concerns(const Range& range, const std::string& curve) {
    return range.curve == curve;
}
bool concerns(const Match& match, const std::string& curve) {
    return match.curve == curve || match.with_curve == curve;
}
bool concerns(const Straight& straight, const std::string& curve) {
    return straight.curve == curve;
}
bool concerns(const Seam& seam, const std::string& curve) {
    return seam.curve == curve;
}
bool concerns(const TotalArea& /*area*/, const std::string& /*curve*/) {
    return false;
}
bool concerns(const Pin& /*pin*/, const std::string& /*curve*/) {
    return false;
}

bool is_on_any(const std::vector<CurveSource>& curves, const std::string& point) {
    return std::any_of(curves.begin(), curves.end(), [&](const CurveSource& curve) {
        const auto* path = std::get_if<ShortestPath>(&curve.form);
        return path != nullptr && is_named(path->through, point);
    });
}

}  // namespace

bool is_shown_only(const Request& request, const CurveSource& curve) {
    if (!std::holds_alternative<Polyline>(curve.form) &&
        !std::holds_alternative<ShortestPath>(curve.form))
        return false;
    const std::string& name = curve.name;
    if (std::find(meaningful.begin(), meaningful.end(), name) != meaningful.end()) return false;
    if (is_named(request.cut.cuts, name) || is_named(request.cut.seams, name)) return false;
    const bool is_bound = std::any_of(
        request.constraints.begin(), request.constraints.end(), [&](const Constraint& constraint) {
            return std::visit([&](const auto& demand) { return concerns(demand, name); },
                              constraint.demand);
        });
    return !is_bound && std::none_of(request.weights.zones.begin(), request.weights.zones.end(),
                                     [&](const Zone& zone) { return zone.curve == name; });
}

ShownApart shown_apart(Request request) {
    ShownApart apart;
    const auto first_shown =
        std::stable_partition(request.curves.begin(), request.curves.end(),
                              [&](const CurveSource& c) { return !is_shown_only(request, c); });
    apart.shown.assign(std::make_move_iterator(first_shown),
                       std::make_move_iterator(request.curves.end()));
    request.curves.erase(first_shown, request.curves.end());
    apart.points = request.points;
    std::erase_if(request.points, [&](const PointSource& point) {
        return is_on_any(apart.shown, point.name) && !is_on_any(request.curves, point.name);
    });
    apart.request = std::move(request);
    return apart;
}

Reach reach_of_change(const ShownApart& from, const ShownApart& to) {
    const Request &was = from.request, &is = to.request;
    if (was.weld != is.weld || was.cut.holes != is.cut.holes ||
        was.cut.features != is.cut.features || says_how_to_cut(was) != says_how_to_cut(is))
        return Reach::model;
    if (was.cut != is.cut || was.curves != is.curves || was.points != is.points)
        return Reach::regions;
    if (was != is) return Reach::pattern;
    return from.shown == to.shown && from.points == to.points ? Reach::nothing : Reach::curves;
}

}  // namespace lastflat
