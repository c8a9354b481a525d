// The whole method: a model's bytes in, flat pieces and their certificate out.
#pragma once

#include <string_view>

#include "core/constrain/resolve_conflicts.h"
#include "core/cut/cut.h"
#include "core/fan/geodesic_fan.h"
#include "core/landmarks/landmarks.h"
#include "core/layout/sheet.h"
#include "core/load/load_model.h"
#include "core/locate/curves.h"
#include "core/measure/report.h"
#include "core/outline/outline.h"
#include "core/parameterize/distortion_weights.h"
#include "core/parameterize/method.h"
#include "core/progress.h"
#include "core/weld/weld.h"

namespace lastflat {

struct FlattenOptions {
    LoadLimits limits;
    WeldOptions weld;
    std::vector<PointSource> points;
    std::vector<CurveSource> curves;
    CutOptions cut;
    std::vector<Constraint> constraints;
    OnConflict on_conflict = OnConflict::fail;
    DistortionWeights weights;               ///< of `isometric`
    std::optional<MaterialLimits> material;  ///< judged, not enforced
    MethodOptions method;
    bool draw_fan = false;  ///< the geodesic fan in the drawing
    /// Up to how many triangles of a region its fan is computed, and if it is to be drawn.
    std::size_t fan_triangles = 20'000, drawn_fan_triangles = 250'000;
    double layout_gap_mm = 10.0;
    std::size_t threads = 1;
};

struct FlatRegion {
    Region region;
    Chart chart;
    Outline outline;
    Metrics metrics;
    std::vector<CurveReport> curves;
    StretchReport stretch;
    int iterations = 0;  ///< Newton steps; 0 for methods without any
    /// Of methods that minimise an energy: its mean density, and how flat it is there (`Minimum`).
    std::optional<double> energy{}, projected_gradient{};
    std::optional<GeodesicFan> fan{};
};

struct Timing {
    double load_ms = 0.0, cut_ms = 0.0, parameterize_ms = 0.0, constrain_ms = 0.0, total_ms = 0.0;
};

struct FlattenResult {
    MethodName method = MethodName::isometric;
    std::vector<FlatRegion> regions;
    std::vector<PairReport> pairs;
    std::vector<Constraint> asked;
    std::vector<ConstraintReport> constraints;  ///< of what was asked
    Sheet sheet;
    std::vector<Warning> warnings;
    /// Vertices that curves made, in the order of their ids, which follow those of the file.
    std::vector<SurfacePlace> added_vertices;
    std::optional<Landmarks> found;     ///< of a bare last
    double smallest_added_angle = 0.0;  ///< of the triangles that curves made; radians
    std::size_t file_vertices = 0;
    std::vector<Repair> repairs;  ///< what was changed in the model before
    Timing timing;
    bool draw_fan = false;
};

/// Flattens a last.
///
/// In:     the bytes of a model (see `load_model`), the shoe-maker's constraints.
/// Out:    every chosen region, flat; no triangle flipped; with `isometric` every constraint kept
/// to
///         `tolerance::locked_length` and no border that crosses itself. The same bytes and options
///         give the same result, whatever `threads` is.
/// Throws: Error, of any code; nothing is returned in part.
[[nodiscard]] FlattenResult flatten(std::string_view model, const FlattenOptions& options,
                                    Progress& progress);

}  // namespace lastflat
