// The result of a flattening, as it stands on the wire. Lengths in mm.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lastflat::api {

using Point = std::array<double, 2>;
using Place = std::array<double, 3>;

struct SegmentResult {
    std::string curve;
    std::int32_t first, last;
};

struct CurveResult {
    std::string name;
    bool locked;
    double length_3d_mm, length_2d_mm, error_mm, worst_edge_error_mm;
    std::string verdict;
};

struct ConstraintResult {
    std::string kind, title;
    std::string pointer;  ///< where it stands in the request
    std::string region;
    std::string unit;  ///< mm, mm2
    std::optional<double> asked_min, asked_max;
    double reached, residual_mm;
    Place position;
    std::string verdict;  ///< pass, relaxed, fail
};

struct PercentilesResult {
    double p01, p05, p50, p95, p99;
};

struct WorstPlaceResult {
    Place position;
    double larger_percent, smaller_percent;
};

struct StretchResult {
    PercentilesResult larger_percent, smaller_percent;
    double most_stretched_percent, most_compressed_percent;
    std::vector<WorstPlaceResult> worst;
    std::optional<double> beyond_material;
    std::optional<std::string> material_verdict;
};

struct MetricsResult {
    double stretch_l2, stretch_linf, stretch_l2_normalised, stretch_linf_normalised;
    double symmetric_dirichlet, angle_distortion;
    double area_3d_mm2, area_2d_mm2, area_error, area_error_p95;
    std::string area_verdict;
    std::int32_t flipped_triangles, border_crossings;
};

struct SpokeResult {
    std::int32_t index;  ///< into uv_mm
    double angle_deg, distance_mm;
};

struct FanResult {
    std::int32_t centre_vertex;  ///< id of the file; -1: a curve made it
    double a_1_mm, a_inf_mm, radius_mm;
    std::vector<SpokeResult> spokes;
};

/// A vertex that a curve made: the weighted mean of three vertices of the file.
struct SourcePoint {
    std::int32_t vertex;  ///< of the region
    std::array<std::int32_t, 3> triangle;
    std::array<double, 3> weights;
};

struct LoopResult {
    std::vector<Point> points_mm;
    std::vector<SegmentResult> segments;
};

struct RegionResult {
    std::string name, method;
    std::vector<Point> uv_mm;
    std::vector<std::array<std::int32_t, 3>> triangles;
    std::vector<std::int32_t> source_vertices;  ///< ids of the file; -1: a curve made it
    std::vector<SourcePoint> source_points;     ///< where those are
    LoopResult outline;
    std::vector<LoopResult> holes;
    std::vector<CurveResult> curves;
    MetricsResult metrics;
    StretchResult stretch;
    int iterations;
    std::optional<double> energy, projected_gradient;
    std::optional<FanResult> fan;
};

struct PairResult {
    std::string curve, a, b;
    double length_mm, difference_mm;
    std::string verdict;
};

struct PlacementResult {
    std::string region;
    double rotation_deg;
    Point translation_mm;
    bool mirrored;
};

/// A curve that was found, in the form in which it may be sent back.
struct FoundCurve {
    std::string name;
    std::vector<std::int32_t> vertices;
    std::vector<std::array<double, 3>> polyline;
};

/// What was found on a bare last.
struct FoundLandmarks {
    std::string foot;  ///< "left", "right"
    std::array<double, 3> up{}, forward{}, heel_point{}, toe_point{};
    double featherline_confidence = 0.0, topline_confidence = 0.0, sides_confidence = 0.0;
    std::vector<FoundCurve> curves;
    std::int32_t lateral_vertex = 0, medial_vertex = 0;
};

struct AddedVertices {
    std::uint64_t count = 0;
    double smallest_angle_deg = 0.0;  ///< of the triangles that curves made
};

struct RepairResult {
    std::string code, detail;
    std::uint64_t count = 0;
    std::vector<std::array<double, 3>> positions;
};

struct WarningResult {
    std::string code, detail;
    std::optional<Place> position;
};

struct FlattenResult {
    std::vector<RegionResult> regions;
    std::vector<PairResult> pairs;
    std::vector<ConstraintResult> constraints;
    double width_mm = 0.0, height_mm = 0.0;
    std::vector<PlacementResult> placements;
    std::vector<WarningResult> warnings;
    std::vector<RepairResult> repairs;
    std::optional<AddedVertices> added;
    std::optional<FoundLandmarks> found;
    double load_ms = 0.0, cut_ms = 0.0, parameterize_ms = 0.0, constrain_ms = 0.0, total_ms = 0.0;
    std::string version;
};

/// The body of GET /v1/jobs/{id}/result. The same result gives the same bytes.
[[nodiscard]] std::string to_json(const FlattenResult& result);

/// The same without what grows with the mesh: no coordinates, triangles, outlines, fan or layout.
[[nodiscard]] std::string metrics_json(const FlattenResult& result);

}  // namespace lastflat::api
