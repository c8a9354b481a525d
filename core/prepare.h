// From a model's bytes to regions: what comes before any flattening.
#pragma once

#include <string_view>

#include "core/cut/cut_surface.h"
#include "core/cut/source_ids.h"
#include "core/measure/featherline.h"

namespace lastflat {

/// Triangles of a file that bear the same names, and no others.
struct NamedFaces {
    std::vector<std::string> names;  ///< ascending
    std::size_t triangles = 0;
    bool operator==(const NamedFaces&) const = default;
};

/// A model, read and mended.
struct ReadModel {
    std::size_t vertices = 0, triangles = 0;  ///< of the file
    std::vector<NamedFaces> groups;           ///< every triangle of the file is in one
    SurfaceMesh surface;
    double load_ms = 0.0;
};

/// Throws: Error, of `load_model` and `weld`.
[[nodiscard]] ReadModel read_model(std::string_view model, const FlattenOptions& options,
                                   Progress& progress);

/// Regions, and all that is to be done with them.
struct Prepared {
    Plan plan;
    Curves curves;                   ///< in the surface
    std::vector<std::string> seams;  ///< the plan's, then those that opened holes
    std::vector<Region> regions;
    std::vector<Constraint> constraints;  ///< the plan's, and one for every seam
    std::vector<FeatherlineSide> featherlines;
    SourceIds sources;
    double smallest_added_angle = 0.0;  ///< of the triangles that curves made; radians
    std::vector<Warning> warnings;
    std::vector<Repair> repairs;  ///< what was changed in the model before
    double load_ms = 0.0;
};

/// Cuts the surface as planned. Constraints, zones and points of the featherline then fit the
/// regions.
/// Throws: Error, as `cut_surface`, `check_constraints`, `check_zones`, `divide_featherlines`.
[[nodiscard]] Prepared prepare(SurfaceMesh surface, Plan plan, Progress& progress);

/// Asks something else of the same regions: a plan with the same curves and cuts.
/// Throws: Error, as `check_constraints`, `check_zones`; nothing is changed then.
void ask(Prepared& prepared, Plan plan);

/// All of it: `read_model`, `make_plan`, and the above.
[[nodiscard]] Prepared prepare(std::string_view model, const FlattenOptions& options,
                               Progress& progress);

}  // namespace lastflat
