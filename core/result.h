// What a flattening comes to.
#pragma once

#include "core/cut/source_ids.h"
#include "core/fan/geodesic_fan.h"
#include "core/layout/sheet.h"
#include "core/measure/report.h"
#include "core/outline/outline.h"
#include "core/plan/plan.h"

namespace lastflat {

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
    Plan plan;  ///< that was run
    std::vector<FlatRegion> regions;
    std::vector<FeatherlineSide> featherlines;  ///< whose zones are known
    std::vector<PairReport> pairs;
    std::vector<Constraint> asked;              ///< by the plan, and of every seam
    std::vector<ConstraintReport> constraints;  ///< of what was asked
    Sheet sheet;
    std::vector<Warning> warnings;
    SourceIds sources;
    double smallest_added_angle = 0.0;  ///< of the triangles that curves made; radians
    std::vector<Repair> repairs;        ///< what was changed in the model before
    Timing timing;
};

}  // namespace lastflat
