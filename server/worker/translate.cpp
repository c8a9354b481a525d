#include "server/worker/translate.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "server/support/version.h"

namespace lastflat::server {
namespace {

double millimetres(api::Unit unit) {
    switch (unit) {
        case api::Unit::mm: return 1.0;
        case api::Unit::cm: return 10.0;
        case api::Unit::m: return 1000.0;
        case api::Unit::in: return 25.4;
    }
    return 1.0;
}

Vec3 position_of(const api::Position& p) {
    return {p[0], p[1], p[2]};
}

PointSource point_of(const std::string& name, const api::PlaceRequest& place) {
    PointSource point{name, place.vertex, std::nullopt};
    if (place.position) point.position = position_of(*place.position);
    return point;
}

HoleRule rule_of(api::Holes holes) {
    switch (holes) {
        case api::Holes::automatic: return HoleRule::automatic;
        case api::Holes::keep: return HoleRule::keep;
        case api::Holes::open: return HoleRule::open;
    }
    return HoleRule::automatic;
}

CurveSource curve_of(const api::CurveRequest& curve) {
    CurveSource source{curve.name, curve.vertices};
    for (const api::Position& p : curve.polyline) source.polyline.push_back(position_of(p));
    if (curve.form == api::CurveForm::geodesic) {
        source.through = {curve.from};
        source.through.insert(source.through.end(), curve.via.begin(), curve.via.end());
        source.through.push_back(curve.to);
    }
    source.border_of = curve.border_of_groups;
    if (curve.border_at) source.border_at = point_of("", *curve.border_at);
    source.line = curve.line;
    return source;
}

MethodName method_name(api::Method method) {
    switch (method) {
        case api::Method::tutte: return MethodName::tutte;
        case api::Method::chord_length: return MethodName::chord_length;
        case api::Method::shape_preserving: return MethodName::shape_preserving;
        case api::Method::harmonic: return MethodName::harmonic;
        case api::Method::wachspress: return MethodName::wachspress;
        case api::Method::mean_value: return MethodName::mean_value;
        case api::Method::virtual_border: return MethodName::virtual_border;
        case api::Method::geodesic_fan: return MethodName::geodesic_fan;
        case api::Method::mips: return MethodName::mips;
        case api::Method::green_lagrange: return MethodName::green_lagrange;
        case api::Method::isometric: return MethodName::isometric;
    }
    return MethodName::isometric;
}

BorderShape border_shape(api::Border border) {
    switch (border) {
        case api::Border::square: return BorderShape::square;
        case api::Border::circle: return BorderShape::circle;
        case api::Border::hull: return BorderShape::hull;
        case api::Border::floating: return BorderShape::floating;
    }
    return BorderShape::circle;
}

MethodOptions method_of(const api::MethodRequest& request) {
    MethodOptions method;
    method.name = method_name(request.name);
    if (request.border) method.border = border_shape(*request.border);
    method.angles = request.angles.value_or(api::Angles::curvature) == api::Angles::curvature
                        ? AngleRule::curvature
                        : AngleRule::averaged_conformal;
    return method;
}

ConstraintKind kind_of(api::ConstraintForm form) {
    switch (form) {
        case api::ConstraintForm::lock: return ConstraintKind::lock;
        case api::ConstraintForm::range: return ConstraintKind::range;
        case api::ConstraintForm::match: return ConstraintKind::match;
        case api::ConstraintForm::straight: return ConstraintKind::straight;
        case api::ConstraintForm::total_area: return ConstraintKind::total_area;
        case api::ConstraintForm::pin: return ConstraintKind::pin;
    }
    return ConstraintKind::lock;
}

Constraint constraint_of(const api::ConstraintRequest& wire) {
    Constraint constraint;
    constraint.kind = kind_of(wire.form);
    constraint.curve = wire.curve;
    constraint.keep = wire.keep == api::KeepLength::edges ? Keep::edges : Keep::total;
    // An area with neither bound is kept exactly; a range has at least one.
    const bool exact = !wire.min_percent && !wire.max_percent;
    constexpr double unbounded = std::numeric_limits<double>::infinity();
    constraint.min_percent = exact ? 0.0 : wire.min_percent.value_or(-unbounded);
    constraint.max_percent = exact ? 0.0 : wire.max_percent.value_or(unbounded);
    constraint.region = wire.region;
    constraint.with_curve = wire.with_curve;
    constraint.with_region = wire.with_region;
    constraint.vertex = wire.vertex;
    constraint.place = {wire.at_mm[0], wire.at_mm[1]};
    constraint.priority = wire.priority;
    constraint.option = wire.path;
    return constraint;
}

DistortionWeights weights_of(const api::WeightsRequest& wire) {
    DistortionWeights weights;
    weights.stretch = wire.stretch;
    weights.compression = wire.compression;
    for (const auto& zone : wire.zones) {
        weights.zones.push_back(
            {zone.curve, zone.vertex, zone.vertices, zone.within_mm, zone.weight});
    }
    return weights;
}

std::string word(MethodName method) {
    switch (method) {
        case MethodName::tutte: return "tutte";
        case MethodName::chord_length: return "chord_length";
        case MethodName::shape_preserving: return "shape_preserving";
        case MethodName::harmonic: return "harmonic";
        case MethodName::wachspress: return "wachspress";
        case MethodName::mean_value: return "mean_value";
        case MethodName::virtual_border: return "virtual_border";
        case MethodName::geodesic_fan: return "geodesic_fan";
        case MethodName::mips: return "mips";
        case MethodName::green_lagrange: return "green_lagrange";
        case MethodName::isometric: return "isometric";
    }
    return {};
}

std::string word(Verdict verdict) {
    switch (verdict) {
        case Verdict::pass: return "pass";
        case Verdict::warn: return "warn";
        case Verdict::fail: return "fail";
    }
    return {};
}

std::vector<api::Point> to_wire(const Points2& points) {
    std::vector<api::Point> result;
    result.reserve(points.size());
    for (const Vec2& p : points) result.push_back({p.x(), p.y()});
    return result;
}

api::MetricsResult to_wire(const Metrics& m) {
    return {m.stretch_l2,
            m.stretch_linf,
            m.stretch_l2_normalised,
            m.stretch_linf_normalised,
            m.symmetric_dirichlet,
            m.angle_distortion,
            m.area_3d_mm2,
            m.area_2d_mm2,
            m.area_error,
            m.area_error_p95,
            word(m.area_verdict),
            m.flipped_triangles,
            m.border_crossings};
}

api::FanResult to_wire(const GeodesicFan& fan, const Region& region) {
    api::FanResult wire{fan.centre, fan.mean_distance, fan.greatest_distance, fan.radius, {}};
    for (std::size_t i = 0; i < fan.spokes.size(); ++i) {
        wire.spokes.push_back({region.border[i], fan.spokes[i].angle * 180.0 / std::numbers::pi,
                               fan.spokes[i].distance});
    }
    return wire;
}

api::Place to_wire(const Vec3& p) {
    return {p.x(), p.y(), p.z()};
}

api::PercentilesResult to_wire(const StretchPercentiles& p) {
    return {p.p01, p.p05, p.p50, p.p95, p.p99};
}

api::StretchResult to_wire(const StretchReport& report) {
    api::StretchResult wire{to_wire(report.larger),
                            to_wire(report.smaller),
                            report.most_stretched_percent,
                            report.most_compressed_percent,
                            {},
                            {},
                            {}};
    for (const auto& w : report.worst)
        wire.worst.push_back({to_wire(w.position), w.larger_percent, w.smaller_percent});
    if (report.material_verdict) {
        wire.beyond_material = report.beyond_material;
        wire.material_verdict = word(*report.material_verdict);
    }
    return wire;
}

std::optional<double> finite(double value) {
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

api::ConstraintResult to_wire(const ConstraintReport& report, const Constraint& constraint) {
    return {std::string(name(constraint.kind)),
            constraint.title(),
            json_pointer(constraint.option),
            report.region,
            constraint.kind == ConstraintKind::total_area ? "mm2" : "mm",
            finite(report.asked_min),
            finite(report.asked_max),
            report.reached,
            report.residual_mm,
            to_wire(report.position),
            report.kept      ? "pass"
            : report.relaxed ? "relaxed"
                             : "fail"};
}

/// The way back to the model: ids of the file, and places between them for vertices that curves
/// made.
void trace_back(const FlattenResult& result, api::RegionResult& region) {
    const auto file_vertices = static_cast<Index>(result.file_vertices);
    for (std::size_t v = 0; v < region.source_vertices.size(); ++v) {
        Index& source = region.source_vertices[v];
        if (source < file_vertices) continue;
        const SurfacePlace& place =
            result.added_vertices[static_cast<std::size_t>(source - file_vertices)];
        region.source_points.push_back({static_cast<std::int32_t>(v),
                                        place.corners,
                                        {place.weights[0], place.weights[1], place.weights[2]}});
        source = -1;
    }
    if (!region.fan) return;
    std::int32_t& centre = region.fan->centre_vertex;
    centre = region.source_vertices[static_cast<std::size_t>(centre)];
}

api::LoopResult to_wire(const OutlineLoop& loop) {
    api::LoopResult wire{to_wire(loop.points), {}};
    for (const auto& s : loop.segments) wire.segments.push_back({s.curve, s.first, s.last});
    return wire;
}

api::RegionResult to_wire(const FlatRegion& flat, MethodName method) {
    api::RegionResult region;
    region.name = flat.region.name;
    region.method = word(method);
    region.uv_mm = to_wire(flat.chart.uv);
    region.triangles.assign(flat.region.triangles.begin(), flat.region.triangles.end());
    region.source_vertices = flat.region.source_vertices;
    region.outline = to_wire(flat.outline);
    for (const OutlineLoop& hole : flat.outline.holes) region.holes.push_back(to_wire(hole));
    for (const auto& c : flat.curves) {
        region.curves.push_back({c.name, c.locked, c.length_3d_mm, c.length_2d_mm, c.error_mm,
                                 c.worst_edge_error_mm, word(c.verdict)});
    }
    region.metrics = to_wire(flat.metrics);
    region.stretch = to_wire(flat.stretch);
    region.iterations = flat.iterations;
    region.energy = flat.energy;
    region.projected_gradient = flat.projected_gradient;
    if (flat.fan) region.fan = to_wire(*flat.fan, flat.region);
    return region;
}

}  // namespace

FlattenOptions to_options(const api::FlattenRequest& request) {
    FlattenOptions options;
    if (request.units) options.weld.unit_mm = millimetres(*request.units);
    if (request.unit_mm) options.weld.unit_mm = request.unit_mm;
    options.weld.groups = request.surface_groups;
    options.weld.tolerance_mm = request.weld_tolerance_mm;
    options.weld.stitch_mm = request.stitch_mm;
    for (const auto& [name, place] : request.points)
        options.points.push_back(point_of(name, place));
    for (const auto& curve : request.curves) options.curves.push_back(curve_of(curve));
    options.cut.cuts = request.cuts;
    options.cut.seams = request.seams;
    options.cut.holes = rule_of(request.holes);
    for (const auto& region : request.regions) {
        RegionChoice choice{region.name, {}, {}};
        if (region.contains) {
            choice.vertex = region.contains->vertex;
            if (region.contains->position)
                choice.position = position_of(*region.contains->position);
        }
        options.cut.regions.push_back(choice);
    }
    for (const auto& wire : request.constraints) options.constraints.push_back(constraint_of(wire));
    options.on_conflict =
        request.on_conflict == api::Conflict::relax ? OnConflict::relax : OnConflict::fail;
    options.weights = weights_of(request.weights);
    if (request.material) {
        options.material = {request.material->stretch_max_percent,
                            request.material->compress_max_percent};
    }
    options.method = method_of(request.method);
    options.draw_fan = request.draw_fan;
    return options;
}

api::FoundLandmarks to_wire(const Landmarks& found) {
    api::FoundLandmarks wire{found.foot == Foot::left ? "left" : "right",
                             to_wire(found.up),
                             to_wire(found.forward),
                             to_wire(found.heel_point),
                             to_wire(found.toe_point),
                             found.featherline_confidence,
                             found.topline_confidence,
                             found.sides_confidence,
                             {},
                             found.cut.regions[0].vertex.value(),
                             found.cut.regions[1].vertex.value()};
    for (const CurveSource& curve : found.curves) {
        wire.curves.push_back({curve.name, curve.vertices, {}});
        for (const Vec3& point : curve.polyline)
            wire.curves.back().polyline.push_back(to_wire(point));
    }
    return wire;
}

std::vector<api::RepairResult> to_wire(const std::vector<Repair>& repairs) {
    std::vector<api::RepairResult> wire;
    for (const Repair& repair : repairs) {
        wire.push_back({repair.code, repair.detail, repair.count, {}});
        for (const Vec3& position : repair.positions)
            wire.back().positions.push_back(to_wire(position));
    }
    return wire;
}

api::FlattenResult to_wire(const FlattenResult& result) {
    api::FlattenResult wire;
    for (const auto& flat : result.regions) {
        wire.regions.push_back(to_wire(flat, result.method));
        trace_back(result, wire.regions.back());
    }
    if (result.found) wire.found = to_wire(*result.found);
    if (!result.added_vertices.empty())
        wire.added = {
            {result.added_vertices.size(), result.smallest_added_angle * 180.0 / std::numbers::pi}};
    for (const auto& p : result.pairs) {
        wire.pairs.push_back({p.curve, p.a, p.b, p.length_mm, p.difference_mm, word(p.verdict)});
    }
    for (const auto& c : result.constraints)
        wire.constraints.push_back(to_wire(c, result.asked[c.constraint]));
    wire.width_mm = result.sheet.width;
    wire.height_mm = result.sheet.height;
    for (std::size_t r = 0; r < result.regions.size(); ++r) {
        const Placement& p = result.sheet.placements[r];
        wire.placements.push_back({result.regions[r].region.name,
                                   p.rotation * 180.0 / std::numbers::pi,
                                   {p.translation.x(), p.translation.y()},
                                   p.mirrored});
    }
    wire.repairs = to_wire(result.repairs);
    for (const auto& w : result.warnings) {
        wire.warnings.push_back({w.code, w.detail, std::nullopt});
        if (w.position) wire.warnings.back().position = to_wire(*w.position);
    }
    const Timing& t = result.timing;
    wire.load_ms = t.load_ms;
    wire.cut_ms = t.cut_ms;
    wire.parameterize_ms = t.parameterize_ms;
    wire.constrain_ms = t.constrain_ms;
    wire.total_ms = t.total_ms;
    wire.version = version;
    return wire;
}

}  // namespace lastflat::server
