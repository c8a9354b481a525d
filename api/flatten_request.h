// The request of a flattening: the shoe-maker's constraints, as they stand on the wire.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/webhook_request.h"

namespace lastflat::api {

enum class Unit { mm, cm, m, in };
enum class CurveForm { vertices, polyline, geodesic, border_of, border_at, line };
enum class KeepLength { edges, total };
enum class Method {
    tutte,
    chord_length,
    shape_preserving,
    harmonic,
    wachspress,
    mean_value,
    virtual_border,
    geodesic_fan,
    mips,
    green_lagrange,
    isometric
};
enum class Border { square, circle, hull, floating };
enum class Angles { curvature, averaged_conformal };

using Position = std::array<double, 3>;  ///< in the model's coordinates, scaled to mm

struct PlaceRequest {  ///< one of both
    std::optional<std::int32_t> vertex;
    std::optional<Position> position;
};

/// The fields of its form are filled, the others empty.
struct CurveRequest {
    std::string name;
    CurveForm form = CurveForm::vertices;
    std::vector<std::int32_t> vertices;
    std::vector<Position> polyline;
    std::string from, to;
    std::vector<std::string> via;
    std::vector<std::string> border_of_groups;  ///< one or two
    std::optional<PlaceRequest> border_at;
    std::string line;  ///< a line of the model
};

struct RegionRequest {
    std::string name;  ///< `exterior`, `interior` are read as `lateral`, `medial`
    std::optional<PlaceRequest> contains;
};

enum class ConstraintForm { lock, range, match, straight, total_area, pin };

/// The fields of its form are filled, the others empty.
struct ConstraintRequest {
    ConstraintForm form = ConstraintForm::lock;
    std::string curve, region;
    std::string with_curve, with_region;
    KeepLength keep = KeepLength::edges;
    std::optional<double> min_percent, max_percent;
    std::int32_t vertex = -1;
    std::array<double, 2> at_mm{};
    std::int32_t priority = 0;
    std::vector<std::string> path;  ///< where it stands: {"locks", "0"}
};

enum class Conflict { fail, relax };
enum class Holes { automatic, keep, open };

/// Of the three ways to tell a zone one is given.
struct ZoneRequest {
    std::string curve;
    std::int32_t vertex = -1;
    std::vector<std::int32_t> vertices;
    double within_mm = 0.0;
    double weight = 1.0;
};

struct WeightsRequest {
    double stretch = 1.0, compression = 1.0;
    std::vector<ZoneRequest> zones;
};

struct MaterialRequest {
    double stretch_max_percent, compress_max_percent;
};

struct MethodRequest {
    Method name = Method::isometric;
    std::optional<Border> border;
    std::optional<Angles> angles;
};

/// Lengths in mm; vertex ids from 0, in file order.
struct FlattenRequest {
    std::optional<Unit> units;
    std::optional<double> unit_mm;            ///< "units" as a number: one unit of the model
    std::vector<std::string> surface_groups;  ///< empty: every face
    std::optional<double> weld_tolerance_mm, stitch_mm;
    std::vector<std::pair<std::string, PlaceRequest>> points;
    std::vector<CurveRequest> curves;
    std::vector<std::string> cuts, seams;
    Holes holes = Holes::automatic;
    std::vector<RegionRequest> regions;
    std::vector<ConstraintRequest> constraints;  ///< "locks", then "constraints"
    Conflict on_conflict = Conflict::fail;
    WeightsRequest weights;
    std::optional<MaterialRequest> material;
    MethodRequest method;
    bool draw_fan = false;  ///< "draw": ["fan"]
    std::string tag;
};

struct RequestLimits {
    std::size_t bytes = 32u << 20;
    int depth = 12;
    std::size_t curves = 256;
    std::size_t curve_vertices = 1'000'000;
    std::size_t regions = 64;
    std::size_t list = 1024;  ///< of any other list
    std::size_t name_bytes = 128;
};

/// Reads the constraint JSON. Absent or empty text: every default.
/// Throws: InvalidRequest naming the field; an unknown field is an error.
[[nodiscard]] FlattenRequest flatten_request_from_json(std::string_view text,
                                                       const RequestLimits& limits = {});

/// A request sent as JSON alone: the model in base64 beside the constraints.
struct JsonSubmission {
    std::string model;     ///< decoded; empty if `asset_id` is given
    std::string asset_id;  ///< of a model that was sent before
    FlattenRequest request;
    std::string request_text;  ///< its JSON; empty if absent
    std::optional<WebhookRequest> webhook;
};

/// Reads {"model": {"data": base64} or {"asset_id": id}, "request": {...}, "webhook": {...}};
/// pointers begin at this document.
/// Throws: InvalidRequest naming the field.
[[nodiscard]] JsonSubmission json_submission_from_json(std::string_view text,
                                                       const RequestLimits& limits = {});

/// The wire's words, in the order of the enumerations.
[[nodiscard]] const std::vector<std::string>& unit_names();
[[nodiscard]] const std::vector<std::string>& method_names();
[[nodiscard]] const std::vector<std::string>& constraint_names();

}  // namespace lastflat::api
