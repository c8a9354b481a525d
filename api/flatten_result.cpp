#include "api/flatten_result.h"

#include <cmath>
#include <numbers>

#include "api/geometry_text.h"
#include "api/json.h"
#include "api/problem_of.h"
#include "api/request_words.h"
#include "api/result_words.h"
#include "core/constrain/constraint.h"
#include "core/result.h"

namespace lastflat::api {
namespace {

double degrees(double radians) {
    return radians * 180.0 / std::numbers::pi;
}

Json report_json(const ZoneReport& zone) {
    return {{"name", word_of(zone_words, zone.zone)},
            {"length_3d_mm", zone.length_3d_mm},
            {"length_2d_mm", zone.length_2d_mm},
            {"ease_mm", zone.length_2d_mm - zone.length_3d_mm},
            {"ease_percent", ease_percent(zone.length_3d_mm, zone.length_2d_mm)}};
}

Json report_json(const CurveReport& c) {
    Json json{{"name", c.name},
              {"locked", c.locked},
              {"length_3d_mm", c.length_3d_mm},
              {"length_2d_mm", c.length_2d_mm},
              {"error_mm", c.error_mm},
              {"worst_edge_error_mm", c.worst_edge_error_mm}};
    if (c.verdict) {
        json["verdict"] = word_of(verdict_words, *c.verdict);
    } else {
        json["ease_mm"] = c.error_mm;
        json["ease_percent"] = ease_percent(c.length_3d_mm, c.length_2d_mm);
    }
    for (const ZoneReport& zone : c.zones) json["zones"].push_back(report_json(zone));
    return json;
}

Json report_json(const Metrics& m) {
    Json json{{"stretch_l2", m.stretch_l2},
              {"stretch_linf", m.stretch_linf},
              {"stretch_l2_normalised", m.stretch_l2_normalised},
              {"stretch_linf_normalised", m.stretch_linf_normalised},
              {"symmetric_dirichlet", m.symmetric_dirichlet},
              {"angle_distortion", m.angle_distortion},
              {"area_3d_mm2", m.area_3d_mm2},
              {"area_2d_mm2", m.area_2d_mm2},
              {"area_error", m.area_error},
              {"area_error_p95", m.area_error_p95},
              {"flipped_triangles", m.flipped_triangles},
              {"border_crossings", m.border_crossings}};
    if (m.area_verdict) json["area_verdict"] = word_of(verdict_words, *m.area_verdict);
    return json;
}

Json or_null(double bound) {
    return std::isfinite(bound) ? Json(bound) : Json(nullptr);
}

Json report_json(const ConstraintReport& report, const Constraint& constraint) {
    const bool is_area = std::holds_alternative<TotalArea>(constraint.demand);
    return {{"kind", name(constraint)},
            {"title", title(constraint)},
            {"pointer", json_pointer(constraint.option)},
            {"region", report.region},
            {"unit", is_area ? "mm2" : "mm"},
            {"asked_min", or_null(report.asked_min)},
            {"asked_max", or_null(report.asked_max)},
            {"reached", report.reached},
            {"residual_mm", report.residual_mm},
            {"position", json_of(report.position)},
            {"verdict", verdict_word(report)}};
}

Json report_json(const StretchPercentiles& p) {
    return {{"p01", p.p01}, {"p05", p.p05}, {"p50", p.p50}, {"p95", p.p95}, {"p99", p.p99}};
}

Json report_json(const StretchReport& s) {
    Json worst = Json::array();
    for (const WorstStrain& w : s.worst) {
        worst.push_back({{"position", json_of(w.position)},
                         {"larger_percent", w.larger_percent},
                         {"smaller_percent", w.smaller_percent}});
    }
    Json json{{"larger_percent", report_json(s.larger)},
              {"smaller_percent", report_json(s.smaller)},
              {"area_percent", report_json(s.area)},
              {"most_stretched_percent", s.most_stretched_percent},
              {"most_gathered_percent", s.most_gathered_percent},
              {"worst", std::move(worst)}};
    if (s.material_verdict) {
        json["beyond_material"] = s.beyond_material;
        json["material_verdict"] = word_of(verdict_words, *s.material_verdict);
    }
    return json;
}

Json fan_json(const FlatRegion& flat, const SourceIds& sources) {
    const GeodesicFan& fan = *flat.fan;
    Json spokes = Json::array();
    for (std::size_t i = 0; i < fan.spokes.size(); ++i) {
        spokes.push_back({{"index", flat.region.border[i]},
                          {"angle_deg", degrees(fan.spokes[i].angle)},
                          {"distance_mm", fan.spokes[i].distance}});
    }
    const auto centre = sources.file_vertex(flat.region.source_vertices[at(fan.centre)]);
    return {{"centre_vertex", centre ? Json(*centre) : Json()},
            {"a_1_mm", fan.mean_distance},
            {"a_inf_mm", fan.greatest_distance},
            {"radius_mm", fan.radius},
            {"spokes", std::move(spokes)}};
}

enum class Detail { metrics, moved, whole };

std::string region_text(const FlattenResult& result, const FlatRegion& flat, Detail detail) {
    Json json{{"name", flat.region.name},
              {"method", word_of(method_words, result.plan.request.method.name)}};
    json["curves"] = Json::array();
    for (const CurveReport& c : flat.curves) json["curves"].push_back(report_json(c));
    json["metrics"] = report_json(flat.metrics);
    json["stretch"] = report_json(flat.stretch);
    json["iterations"] = flat.iterations;
    if (flat.energy) json["energy"] = *flat.energy;
    if (flat.projected_gradient) json["projected_gradient"] = *flat.projected_gradient;
    if (detail == Detail::metrics) return text_of(json);
    if (flat.fan && tells_fan(result.plan.request)) json["fan"] = fan_json(flat, result.sources);
    std::string text = text_of(json);
    text.pop_back();
    text += "," + chart_text(flat);
    if (detail == Detail::whole) text += "," + mesh_text(flat, result.sources);
    return text + "," + outline_text(flat) + "}";
}

Json layout_json(const FlattenResult& result) {
    Json placements = Json::array();
    for (std::size_t r = 0; r < result.sheet.placements.size(); ++r) {
        const Placement& p = result.sheet.placements[r];
        placements.push_back({{"region", result.regions[r].region.name},
                              {"rotation_deg", degrees(p.rotation)},
                              {"translation_mm", json_of(p.translation)},
                              {"mirrored", p.mirrored}});
    }
    return {{"width_mm", result.sheet.width},
            {"height_mm", result.sheet.height},
            {"placements", std::move(placements)}};
}

Json points_json(const FlattenResult& result) {
    Json points = Json::array();
    for (const FeatherlineSide& side : result.featherlines) {
        for (const ZoneEnd& end : side.ends) {
            points.push_back({{"name", end.name},
                              {"region", result.regions[side.region].region.name},
                              {"position", json_of(end.position)},
                              {"share", end.share},
                              {"given", end.given}});
        }
    }
    return points;
}

/// Everything but the regions.
Json rest_of(const FlattenResult& result, const std::string& version, Detail detail) {
    Json pairs = Json::array(), constraints = Json::array();
    for (const PairReport& p : result.pairs) {
        pairs.push_back({{"curve", p.curve},
                         {"a", p.a},
                         {"b", p.b},
                         {"length_mm", p.length_mm},
                         {"difference_mm", p.difference_mm},
                         {"verdict", word_of(verdict_words, p.verdict)}});
    }
    for (const ConstraintReport& report : result.constraints)
        constraints.push_back(report_json(report, result.asked[report.constraint]));
    Json document{{"pairs", std::move(pairs)},
                  {"constraints", std::move(constraints)},
                  {"points", points_json(result)}};
    if (detail != Detail::metrics) document["layout"] = layout_json(result);
    document["warnings"] = json_of(result.warnings);
    document["repairs"] = json_of(result.repairs);
    if (result.plan.landmarks && detail == Detail::whole) document["found"] = json_of(result.plan);
    if (!result.sources.added.empty()) {
        document["added_vertices"] = {{"count", result.sources.added.size()},
                                      {"smallest_angle_deg", degrees(result.smallest_added_angle)}};
    }
    const Timing& t = result.timing;
    document["timing_ms"] = {{"load", t.load_ms},
                             {"cut", t.cut_ms},
                             {"parameterize", t.parameterize_ms},
                             {"constrain", t.constrain_ms},
                             {"total", t.total_ms}};
    document["version"] = version;
    return document;
}

std::string document_of(const FlattenResult& result, const std::string& version, Detail detail) {
    std::string text = "{\"regions\":[";
    for (const FlatRegion& flat : result.regions) {
        if (text.back() == '}') text += ',';
        text += region_text(result, flat, detail);
    }
    text += ']';
    if (detail == Detail::whole) text += ',' + model_text(result);
    return text + ',' + text_of(rest_of(result, version, detail)).substr(1);
}

}  // namespace

std::string to_json(const FlattenResult& result, const std::string& version) {
    return document_of(result, version, Detail::whole);
}

std::string metrics_json(const FlattenResult& result, const std::string& version) {
    return document_of(result, version, Detail::metrics);
}

std::string moved_json(const FlattenResult& result, const std::string& version) {
    return document_of(result, version, Detail::moved);
}

}  // namespace lastflat::api
