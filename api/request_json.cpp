#include "api/request_json.h"

#include <algorithm>
#include <cmath>

#include "api/request_words.h"
#include "core/overloaded.h"

namespace lastflat::api {
namespace {

using Json = nlohmann::ordered_json;

Json position_json(const Vec3& p) {
    return {p.x(), p.y(), p.z()};
}

Json location_json(const Location& location) {
    return std::visit(Overloaded{[](Index vertex) {
                                     return Json{{"vertex", vertex}};
                                 },
                                 [](const Vec3& p) {
                                     return Json{{"position", position_json(p)}};
                                 }},
                      location);
}

Json path_json(const ShortestPath& path) {
    const auto& names = path.through;
    Json json{{"from", names.front()}, {"to", names.back()}};
    if (names.size() > 2)
        json["via"] = std::vector<std::string>(names.begin() + 1, names.end() - 1);
    return json;
}

Json polyline_json(const Polyline& polyline) {
    Json points = Json::array();
    for (const Vec3& point : polyline.points) points.push_back(position_json(point));
    return {{"polyline", std::move(points)}};
}

Json curve_json(const CurveForm& form) {
    return std::visit(Overloaded{[](const VertexPath& path) {
                                     return Json{{"vertices", path.vertices}};
                                 },
                                 [](const Polyline& polyline) { return polyline_json(polyline); },
                                 [](const ShortestPath& path) { return path_json(path); },
                                 [](const GroupBorder& border) {
                                     return Json{{"border_of", {{"groups", border.groups}}}};
                                 },
                                 [](const BorderAt& border) {
                                     return Json{{"border_at", location_json(border.location)}};
                                 },
                                 [](const NamedLine& line) {
                                     return Json{{"line", line.line}};
                                 }},
                      form);
}

void set_bounds(Json& json, double least, double most) {
    if (std::isfinite(least)) json["min_percent"] = least;
    if (std::isfinite(most)) json["max_percent"] = most;
}

void set_region(Json& json, const std::string& region) {
    if (!region.empty()) json["region"] = region;
}

Json lock_json(const Lock& lock) {
    Json json{{"curve", lock.curve}};
    if (lock.keep != Keep::edges) json["keep"] = word_of(keep_words, lock.keep);
    set_region(json, lock.region);
    return json;
}

/// Sets the fields of its kind.
struct DemandWriter {
    Json& json;

    void operator()(const Lock& lock) const {
        json["kind"] = "lock";
        json.update(lock_json(lock));
    }
    void operator()(const Range& range) const {
        json = {{"kind", "range"}, {"curve", range.curve}};
        set_bounds(json, range.min_percent, range.max_percent);
        set_region(json, range.region);
    }
    void operator()(const Match& match) const {
        json = {{"kind", "match"}, {"curve", match.curve}, {"with_curve", match.with_curve}};
        if (!match.with_region.empty()) json["with_region"] = match.with_region;
        set_region(json, match.region);
    }
    void operator()(const Straight& straight) const {
        json = {{"kind", "straight"}, {"curve", straight.curve}};
        set_region(json, straight.region);
    }
    void operator()(const TotalArea& area) const {
        json = {{"kind", "total_area"}};
        set_bounds(json, area.min_percent, area.max_percent);
        set_region(json, area.region);
    }
    void operator()(const Pin& pin) const {
        json = {{"kind", "pin"}, {"vertex", pin.vertex}, {"at_mm", {pin.at.x(), pin.at.y()}}};
        set_region(json, pin.region);
    }
    /// Stands in "seams".
    void operator()(const Seam&) const {}
};

/// The locks before all else are "locks"; the order of the others counts, too.
void write_constraints(const std::vector<Constraint>& constraints, Json& json) {
    bool locks = true;
    for (const Constraint& constraint : constraints) {
        const auto* lock = std::get_if<Lock>(&constraint.demand);
        locks = locks && lock != nullptr;
        Json item;
        if (locks)
            item = lock_json(*lock);
        else
            std::visit(DemandWriter{item}, constraint.demand);
        if (constraint.priority != 0) item["priority"] = constraint.priority;
        json[locks ? "locks" : "constraints"].push_back(std::move(item));
    }
}

Json zone_json(const Zone& zone) {
    Json json;
    if (!zone.curve.empty()) json["curve"] = zone.curve;
    if (zone.vertex >= 0) json["vertex"] = zone.vertex;
    if (!zone.vertices.empty())
        json["vertices"] = zone.vertices;
    else
        json["within_mm"] = zone.within_mm;
    json["weight"] = zone.weight;
    return json;
}

Json weights_json(const DistortionWeights& weights) {
    Json json;
    if (!weights.even())
        json = {{"stretch", weights.stretch}, {"compression", weights.compression}};
    for (const Zone& zone : weights.zones) json["zones"].push_back(zone_json(zone));
    return json;
}

Json method_json(const MethodOptions& method) {
    const MethodOptions usual;
    Json json;
    if (method.name != usual.name) json["name"] = word_of(method_words, method.name);
    if (method.border != usual.border) json["border"] = word_of(border_words, method.border);
    if (method.angles != usual.angles) json["angles"] = word_of(angle_words, method.angles);
    return json;
}

void write_surface(const WeldOptions& weld, Json& json) {
    if (weld.unit_mm) {
        const bool has_word = std::any_of(std::begin(unit_words), std::end(unit_words),
                                          [&](const auto& w) { return w.value == *weld.unit_mm; });
        json["units"] = has_word ? Json(word_of(unit_words, *weld.unit_mm)) : Json(*weld.unit_mm);
    }
    if (weld.last_length_mm) json["last_length_mm"] = *weld.last_length_mm;
    if (!weld.groups.empty()) json["surface"] = {{"groups", weld.groups}};
    if (weld.coincident) json["weld"]["coincident"] = word_of(coincident_words, *weld.coincident);
    if (weld.tolerance_mm) json["weld"]["tolerance_mm"] = *weld.tolerance_mm;
    if (weld.stitch_mm) json["weld"]["stitch_mm"] = *weld.stitch_mm;
}

}  // namespace

Json request_json(const Request& request) {
    Json json = Json::object();
    write_surface(request.weld, json);
    for (const PointSource& point : request.points)
        json["points"][point.name] = location_json(point.location);
    for (const CurveSource& curve : request.curves)
        json["curves"][curve.name] = curve_json(curve.form);
    const CutOptions& cut = request.cut;
    if (!cut.cuts.empty()) json["cuts"] = cut.cuts;
    if (!cut.seams.empty()) json["seams"] = cut.seams;
    if (cut.holes != HoleRule::automatic) json["holes"] = word_of(hole_words, cut.holes);
    if (cut.features != FeatureRule::automatic)
        json["features"] = word_of(feature_words, cut.features);
    for (const RegionChoice& region : cut.regions) {
        json["regions"][region.name] =
            region.inside ? Json{{"contains", location_json(*region.inside)}} : Json::object();
    }
    write_constraints(request.constraints, json);
    if (request.on_conflict != OnConflict::fail)
        json["on_conflict"] = word_of(conflict_words, request.on_conflict);
    if (const Json weights = weights_json(request.weights); !weights.is_null())
        json["weights"] = weights;
    if (request.material) {
        json["material"] = {{"stretch_max_percent", request.material->stretch_max_percent},
                            {"compress_max_percent", request.material->compress_max_percent}};
    }
    if (const Json method = method_json(request.method); !method.is_null()) json["method"] = method;
    if (request.include_fan) json["include"].push_back("fan");
    if (request.draw_fan) json["draw"].push_back("fan");
    if (request.shading != Shading::area)
        json["draw"].push_back(word_of(draw_words, std::optional(request.shading)));
    return json;
}

}  // namespace lastflat::api
