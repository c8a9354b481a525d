// What is asked, in plain types: the shoe-maker's request, and what one run may take. Above all
// stages: each of them takes its part from here.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/numerics/types.h"

namespace lastflat {

/// Names with a meaning everywhere; all others are free.
namespace curve_name {
/// From the toe point over toe and instep to the topline; may be given in these two parts.
inline constexpr const char* centre_front = "centre_front";
inline constexpr const char *toe = "toe", *instep = "instep";
inline constexpr const char* heel = "heel";  ///< the back curve
inline constexpr const char *featherline = "featherline", *topline = "topline";
}  // namespace curve_name
/// Where zones of the featherline end towards the seat; on each side, so with the region's name
/// behind: toe_end_lateral.
namespace point_name {
inline constexpr const char *toe_end = "toe_end", *joint_end = "joint_end";
inline constexpr const char* waist_end = "waist_end";
}  // namespace point_name
namespace region_name {
inline constexpr const char *lateral = "lateral", *medial = "medial";
}  // namespace region_name

/// What a model may be at most. Every reader checks before it allocates.
struct LoadLimits {
    std::size_t vertices = 4'000'000;  ///< after welding where the format has no indices
    std::size_t triangles = 4'000'000;
    std::size_t polygon_corners = 1024;  ///< of one face
    std::size_t name_bytes = 256;        ///< of one group name
    std::size_t face_names = 64;         ///< of one face
    std::size_t name_sets = 4096;        ///< different sets of names
    std::size_t lines = 4096;            ///< polylines
    std::size_t json_depth = 64;         ///< nesting inside glTF
};

enum class Coincident { join, keep };

struct WeldOptions {
    std::optional<double> unit_mm;  ///< one unit of the model in mm; default: the format's
    /// How long the last is, along the longest side of its box. Says the unit where nobody does,
    /// and must agree with one that is given.
    std::optional<double> last_length_mm{};
    std::vector<std::string> groups;  ///< faces that carry one of these names; empty: all faces
    /// Vertices in one and the same position become one, or not. Default: where the format has to
    /// repeat a vertex (STL; glTF and PLY at a seam of texture); an index of OBJ is meant, so that
    /// a slit stays a slit.
    std::optional<Coincident> coincident{};
    /// Vertices at most this far apart become one. Default: those of the same position; in models
    /// without indices within `tolerance::same_position` of the model's size.
    std::optional<double> tolerance_mm;
    /// Borders at most this far apart are stitched together; 0: none. Default:
    /// `tolerance::near_border` of the model's size, and only if this closes the model; one that is
    /// a single piece only if coincident vertices are joined.
    std::optional<double> stitch_mm;
    bool operator==(const WeldOptions&) const = default;
};

/// A vertex, by its id in the file, or a point in space near the surface, mm.
using Location = std::variant<Index, Vec3>;

struct PointSource {
    std::string name;
    Location location;
    bool operator==(const PointSource&) const = default;
};

/// Vertices of which consecutive ones share an edge.
struct VertexPath {
    std::vector<Index> vertices;
    bool operator==(const VertexPath&) const = default;
};
/// A line in space near the surface, mm.
struct Polyline {
    Points3 points;
    bool operator==(const Polyline&) const = default;
};
/// Named points, joined by shortest paths.
struct ShortestPath {
    std::vector<std::string> through;
    bool operator==(const ShortestPath&) const = default;
};
/// One group of faces: its border; two: where they meet.
struct GroupBorder {
    std::vector<std::string> groups;
    bool operator==(const GroupBorder&) const = default;
};
/// The border loop at a location.
struct BorderAt {
    Location location;
    bool operator==(const BorderAt&) const = default;
};
/// A line of the model.
struct NamedLine {
    std::string line;
    bool operator==(const NamedLine&) const = default;
};

using CurveForm =
    std::variant<VertexPath, Polyline, ShortestPath, GroupBorder, BorderAt, NamedLine>;

struct CurveSource {
    std::string name;
    CurveForm form;
    bool operator==(const CurveSource&) const = default;
};

/// Which of the pieces is meant by a region's name.
struct RegionChoice {
    std::string name;
    std::optional<Location> inside{};  ///< a point's nearest vertex is meant
    bool operator==(const RegionChoice&) const = default;
};

enum class HoleRule {
    automatic,  ///< a hole that stands for much curvature is opened, any other kept
    keep,
    open,
};

/// What becomes of small features of a closed last: pins, knobs, nails, drilled holes, saw cuts.
enum class FeatureRule {
    automatic,  ///< taken off where the curves are to be found
    fill,       ///< taken off
    keep,
};

struct CutOptions {
    std::vector<std::string> cuts{};      ///< names of curves
    std::vector<RegionChoice> regions{};  ///< empty: every piece is a region
    std::vector<std::string> seams{};     ///< curves that are cut, and sewn together
    HoleRule holes = HoleRule::automatic;
    FeatureRule features = FeatureRule::automatic;
    bool operator==(const CutOptions&) const = default;
};

// The kinds of constraints. A curve that runs through several regions is constrained in each,
// unless `region` names one. Percents count from the curve's own length or the region's own area:
// -1 is one per cent less; infinite: no bound.

enum class Keep {
    edges,  ///< every edge of the curve keeps its 3D length
    total,  ///< their sum does
};

/// A curve keeps its length.
struct Lock {
    std::string curve;
    Keep keep = Keep::edges;
    std::string region{};
    bool operator==(const Lock&) const = default;
};

/// A curve's length stays between two shares of its own.
struct Range {
    std::string curve;
    double min_percent = 0.0, max_percent = 0.0;
    std::string region{};
    bool operator==(const Range&) const = default;
};

/// A curve becomes as long as another, in the same region or not.
struct Match {
    std::string curve, region;
    std::string with_curve, with_region;
    bool operator==(const Match&) const = default;
};

/// A curve lies on a line: a vamp cut on the fold.
struct Straight {
    std::string curve;
    std::string region{};
    bool operator==(const Straight&) const = default;
};

/// A region keeps its area, or stays between two shares of it.
struct TotalArea {
    double min_percent = 0.0, max_percent = 0.0;
    std::string region{};
    bool operator==(const TotalArea&) const = default;
};

/// A point lies at a given point of the plane.
struct Pin {
    Index vertex;  ///< id of the file
    Vec2 at;       ///< mm
    std::string region{};
    bool operator==(const Pin&) const = default;
};

/// Both sides of a cut become equally long, stretch by stretch.
struct Seam {
    std::string curve;
    bool operator==(const Seam&) const = default;
};

struct Constraint {
    std::variant<Lock, Range, Match, Straight, TotalArea, Pin, Seam> demand;
    int priority = 0;                   ///< the least important gives way first
    std::vector<std::string> option{};  ///< where it stands in the request
    bool operator==(const Constraint&) const = default;
};

enum class OnConflict {
    fail,   ///< Error{constraints_infeasible}
    relax,  ///< the least important constraint gives way, as little as it has to
};

/// A part of the surface: what lies within a distance of a curve or of a vertex, or the triangles
/// all of whose corners are listed. One of the three.
struct Zone {
    std::string curve{};
    Index vertex = -1;              ///< id of the file
    std::vector<Index> vertices{};  ///< ids of the file
    double within_mm = 0.0;         ///< in a straight line, to the middle of a triangle
    double weight = 1.0;            ///< distortion here counts so much
    bool operator==(const Zone&) const = default;
};

/// Where distortion matters more, and of which sign.
struct DistortionWeights {
    std::vector<Zone> zones{};
    /// Of the leather when it is lasted: it stretches where the pattern is smaller than the last,
    /// and is compressed where it is larger.
    double stretch = 1.0, compression = 1.0;

    [[nodiscard]] bool even() const { return stretch == 1.0 && compression == 1.0; }
    bool operator==(const DistortionWeights&) const = default;
};

/// What the leather will bear.
struct MaterialLimits {
    double stretch_max_percent, compress_max_percent;
    bool operator==(const MaterialLimits&) const = default;
};

enum class MethodName {
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

/// Whether the method minimises an energy: its start is the geodesic fan.
[[nodiscard]] constexpr bool is_energy(MethodName name) {
    return name == MethodName::mips || name == MethodName::green_lagrange ||
           name == MethodName::isometric;
}

enum class BorderShape { square, circle, hull, floating };

enum class AngleRule {
    curvature,           ///< right globally: the conformal map that keeps border lengths
    averaged_conformal,  ///< the paper's: one ring deep
};

struct MethodOptions {
    MethodName name = MethodName::isometric;
    BorderShape border = BorderShape::circle;  ///< of the methods from tutte to mean_value
    AngleRule angles = AngleRule::curvature;   ///< of the border's polygon
    bool operator==(const MethodOptions&) const = default;
};

/// What the colour of the drawing shows of the leather when it is lasted.
enum class Shading {
    area,     ///< strain of its area
    stretch,  ///< the larger principal strain
    gather,   ///< the smaller principal strain
    shear,    ///< the most that a right angle changes
    plain,    ///< nothing: no colour
};

/// What the shoe-maker asks of one pattern.
struct Request {
    WeldOptions weld;
    std::vector<PointSource> points;
    std::vector<CurveSource> curves;
    CutOptions cut;
    std::vector<Constraint> constraints;
    OnConflict on_conflict = OnConflict::fail;
    DistortionWeights weights;               ///< of `isometric`
    std::optional<MaterialLimits> material;  ///< judged, not enforced
    MethodOptions method;
    Shading shading = Shading::area;  ///< of the drawing
    bool draw_fan = false;            ///< the geodesic fan in the drawing
    bool include_fan = false;         ///< the geodesic fan in the result
    bool operator==(const Request&) const = default;
};

/// Whether the result says what the geodesic fan is: the method of that name always does.
[[nodiscard]] inline bool tells_fan(const Request& request) {
    return request.include_fan || request.method.name == MethodName::geodesic_fan;
}

/// If not, the cuts of a closed last are found.
[[nodiscard]] inline bool says_how_to_cut(const Request& request) {
    return !request.cut.cuts.empty() || !request.cut.seams.empty() ||
           !request.cut.regions.empty() || !request.weld.groups.empty();
}

/// A request, and how it is run.
struct FlattenOptions {
    Request request;
    LoadLimits limits;
    std::size_t fan_triangles = 250'000;  ///< of a region, up to which its fan is computed
    double layout_gap_mm = 10.0;
    std::size_t threads = 1;
};

}  // namespace lastflat
