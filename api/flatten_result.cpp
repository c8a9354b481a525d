#include "api/flatten_result.h"

#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "api/report_json.h"

namespace lastflat::api {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& document) {
    return document.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json to_json(const CurveResult& c) {
    return {{"name", c.name},
            {"locked", c.locked},
            {"length_3d_mm", c.length_3d_mm},
            {"length_2d_mm", c.length_2d_mm},
            {"error_mm", c.error_mm},
            {"worst_edge_error_mm", c.worst_edge_error_mm},
            {"verdict", c.verdict}};
}

Json to_json(const MetricsResult& m) {
    return {{"stretch_l2", m.stretch_l2},
            {"stretch_linf", m.stretch_linf},
            {"stretch_l2_normalised", m.stretch_l2_normalised},
            {"stretch_linf_normalised", m.stretch_linf_normalised},
            {"symmetric_dirichlet", m.symmetric_dirichlet},
            {"angle_distortion", m.angle_distortion},
            {"area_3d_mm2", m.area_3d_mm2},
            {"area_2d_mm2", m.area_2d_mm2},
            {"area_error", m.area_error},
            {"area_error_p95", m.area_error_p95},
            {"area_verdict", m.area_verdict},
            {"flipped_triangles", m.flipped_triangles},
            {"border_crossings", m.border_crossings}};
}

Json or_null(const std::optional<double>& value) {
    return value ? Json(*value) : Json(nullptr);
}

Json to_json(const ConstraintResult& c) {
    return {{"kind", c.kind},
            {"title", c.title},
            {"pointer", c.pointer},
            {"region", c.region},
            {"unit", c.unit},
            {"asked_min", or_null(c.asked_min)},
            {"asked_max", or_null(c.asked_max)},
            {"reached", c.reached},
            {"residual_mm", c.residual_mm},
            {"position", c.position},
            {"verdict", c.verdict}};
}

Json to_json(const PercentilesResult& p) {
    return {{"p01", p.p01}, {"p05", p.p05}, {"p50", p.p50}, {"p95", p.p95}, {"p99", p.p99}};
}

Json to_json(const StretchResult& s) {
    Json worst = Json::array();
    for (const auto& w : s.worst) {
        worst.push_back({{"position", w.position},
                         {"larger_percent", w.larger_percent},
                         {"smaller_percent", w.smaller_percent}});
    }
    Json json{{"larger_percent", to_json(s.larger_percent)},
              {"smaller_percent", to_json(s.smaller_percent)},
              {"most_stretched_percent", s.most_stretched_percent},
              {"most_compressed_percent", s.most_compressed_percent},
              {"worst", std::move(worst)}};
    if (s.material_verdict) {
        json["beyond_material"] = *s.beyond_material;
        json["material_verdict"] = *s.material_verdict;
    }
    return json;
}

Json to_json(const FanResult& f) {
    Json spokes = Json::array();
    for (const auto& s : f.spokes) {
        spokes.push_back(
            {{"index", s.index}, {"angle_deg", s.angle_deg}, {"distance_mm", s.distance_mm}});
    }
    return {{"centre_vertex", f.centre_vertex < 0 ? Json() : Json(f.centre_vertex)},
            {"a_1_mm", f.a_1_mm},
            {"a_inf_mm", f.a_inf_mm},
            {"radius_mm", f.radius_mm},
            {"spokes", std::move(spokes)}};
}

void append(std::string& text, double value) {
    if (!std::isfinite(value)) {
        text += "null";
        return;
    }
    std::array<char, 32> digits;
    text.append(digits.data(),
                std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}
void append(std::string& text, std::int32_t value) {
    text += std::to_string(value);
}
template <class List>
void append(std::string& text, const List& list);

void append(std::string& text, const LoopResult& loop) {
    Json segments = Json::array();
    for (const auto& s : loop.segments)
        segments.push_back({{"curve", s.curve}, {"first", s.first}, {"last", s.last}});
    text += "{\"points_mm\":";
    append(text, loop.points_mm);
    text += ",\"segments\":" + text_of(segments) + "}";
}

template <class List>
void append(std::string& text, const List& list) {
    text += '[';
    for (const auto& item : list) {
        append(text, item);
        text += ',';
    }
    if (text.back() == ',') text.pop_back();
    text += ']';
}

/// What grows with the mesh, as the members of an object. Written by hand: as JSON values it would
/// take several times as long, which is a tenth of the time of a small job.
std::string geometry_text(const RegionResult& r) {
    std::string text = "\"uv_mm\":";
    append(text, r.uv_mm);
    text += ",\"triangles\":";
    append(text, r.triangles);
    text += ",\"source_vertices\":[";
    for (const std::int32_t source : r.source_vertices)
        text += (source < 0 ? "null" : std::to_string(source)) + ",";
    if (text.back() == ',') text.pop_back();
    text += "],\"source_points\":[";
    for (const SourcePoint& point : r.source_points) {
        text += "{\"vertex\":" + std::to_string(point.vertex) + ",\"triangle\":";
        append(text, point.triangle);
        text += ",\"weights\":";
        append(text, point.weights);
        text += "},";
    }
    if (text.back() == ',') text.pop_back();
    text += ']';
    text += ",\"outline\":";
    append(text, r.outline);
    text += ",\"holes\":";
    append(text, r.holes);
    return text;
}

Json to_json(const RegionResult& r) {
    Json json{{"name", r.name}, {"method", r.method}};
    json["curves"] = Json::array();
    for (const auto& c : r.curves) json["curves"].push_back(to_json(c));
    json["metrics"] = to_json(r.metrics);
    json["stretch"] = to_json(r.stretch);
    json["iterations"] = r.iterations;
    if (r.energy) json["energy"] = *r.energy;
    if (r.projected_gradient) json["projected_gradient"] = *r.projected_gradient;
    if (r.fan) json["fan"] = to_json(*r.fan);
    return json;
}

}  // namespace

namespace {

std::string region_text(const RegionResult& r, bool with_geometry) {
    Json json = to_json(r);
    if (!with_geometry) json.erase("fan");
    std::string text = text_of(json);
    if (!with_geometry) return text;
    text.pop_back();
    return text + "," + geometry_text(r) + "}";
}

/// Everything but the regions.
Json rest_of(const FlattenResult& result, bool with_geometry) {
    Json pairs = Json::array(), constraints = Json::array(), placements = Json::array(),
         warnings = Json::array();
    for (const auto& p : result.pairs) {
        pairs.push_back({{"curve", p.curve},
                         {"a", p.a},
                         {"b", p.b},
                         {"length_mm", p.length_mm},
                         {"difference_mm", p.difference_mm},
                         {"verdict", p.verdict}});
    }
    for (const auto& c : result.constraints) constraints.push_back(to_json(c));
    for (const auto& p : result.placements) {
        placements.push_back({{"region", p.region},
                              {"rotation_deg", p.rotation_deg},
                              {"translation_mm", p.translation_mm},
                              {"mirrored", p.mirrored}});
    }
    for (const auto& w : result.warnings) {
        warnings.push_back({{"code", w.code}, {"detail", w.detail}});
        if (w.position) warnings.back()["position"] = *w.position;
    }
    Json document{{"pairs", std::move(pairs)}, {"constraints", std::move(constraints)}};
    if (with_geometry) {
        document["layout"] = {{"width_mm", result.width_mm},
                              {"height_mm", result.height_mm},
                              {"placements", std::move(placements)}};
    }
    document["warnings"] = std::move(warnings);
    document["repairs"] = repairs_json(result.repairs);
    if (result.found && with_geometry) document["found"] = found_json(*result.found);
    if (result.added)
        document["added_vertices"] = {{"count", result.added->count},
                                      {"smallest_angle_deg", result.added->smallest_angle_deg}};
    document["timing_ms"] = {{"load", result.load_ms},
                             {"cut", result.cut_ms},
                             {"parameterize", result.parameterize_ms},
                             {"constrain", result.constrain_ms},
                             {"total", result.total_ms}};
    document["version"] = result.version;
    return document;
}

std::string text_of(const FlattenResult& result, bool with_geometry) {
    std::string text = "{\"regions\":[";
    for (const RegionResult& r : result.regions) {
        if (text.back() == '}') text += ',';
        text += region_text(r, with_geometry);
    }
    return text + "]," + text_of(rest_of(result, with_geometry)).substr(1);
}

}  // namespace

Json repairs_json(const std::vector<RepairResult>& repairs) {
    Json list = Json::array();
    for (const RepairResult& repair : repairs) {
        list.push_back({{"code", repair.code},
                        {"count", repair.count},
                        {"detail", repair.detail},
                        {"positions", repair.positions}});
    }
    return list;
}

Json found_json(const FoundLandmarks& found) {
    Json curves = Json::object();
    for (const FoundCurve& curve : found.curves) {
        if (curve.polyline.empty())
            curves[curve.name] = {{"vertices", curve.vertices}};
        else
            curves[curve.name] = {{"polyline", curve.polyline}};
    }
    Json request{{"curves", std::move(curves)},
                 {"cuts", {"featherline", "topline", "centre_front", "heel"}},
                 {"regions",
                  {{"lateral", {{"contains", {{"vertex", found.lateral_vertex}}}}},
                   {"medial", {{"contains", {{"vertex", found.medial_vertex}}}}}}},
                 {"locks", {{{"curve", "centre_front"}}, {{"curve", "heel"}}}}};
    return {{"foot", found.foot},
            {"up", found.up},
            {"forward", found.forward},
            {"heel_point", found.heel_point},
            {"toe_point", found.toe_point},
            {"confidence",
             {{"featherline", found.featherline_confidence},
              {"topline", found.topline_confidence},
              {"sides", found.sides_confidence}}},
            {"request", std::move(request)}};
}

std::string to_json(const FlattenResult& result) {
    return text_of(result, true);
}

std::string metrics_json(const FlattenResult& result) {
    return text_of(result, false);
}

}  // namespace lastflat::api
