// What a model is, without flattening it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/plan/plan.h"
#include "core/prepare.h"

namespace lastflat {

struct BorderLoop {
    double length_mm;
    Vec3 position;  ///< of one of its vertices
};

struct InspectedHole {
    double length_mm;
    Vec3 position;     ///< of one of its vertices
    double curvature;  ///< that it stands for, radians (see `hole_curvatures`)
};

struct InspectedRegion {
    std::string name;
    std::size_t vertices = 0, triangles = 0;
    double area_mm2 = 0.0, border_mm = 0.0;  ///< of the outer loop
    std::vector<InspectedHole> holes{};      ///< that are kept
};

struct Inspection {
    std::size_t file_vertices = 0, file_triangles = 0;
    std::vector<NamedFaces> groups;  ///< every triangle of the file is in one
    double unit_mm = 1.0;            ///< one unit of the model
    // Of the surface: the faces that take part, welded.
    std::size_t vertices = 0, triangles = 0, components = 0;
    double area_mm2 = 0.0;
    Vec3 size_mm = Vec3::Zero();           ///< of the box around it
    std::vector<BorderLoop> border_loops;  ///< longest first; none: it is closed
    std::vector<InspectedRegion> regions;
    std::optional<Error> fault;  ///< why it cannot be cut into regions as asked
    std::vector<Warning> warnings;
    std::vector<Repair> repairs;
    Plan plan;  ///< empty if not even that could be made
};

/// Runs the stages before the flattening.
///
/// Throws: Error, of `load_model` and `weld`: there is no surface to speak of.
[[nodiscard]] Inspection inspect(std::string_view model, const FlattenOptions& options);

}  // namespace lastflat
