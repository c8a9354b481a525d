#include "api/model_report.h"

#include <numbers>

#include "api/json.h"
#include "api/problem_of.h"
#include "core/inspect.h"

namespace lastflat::api {

static Json region_json(const InspectedRegion& r) {
    Json holes = Json::array();
    for (const InspectedHole& hole : r.holes) {
        holes.push_back({{"length_mm", hole.length_mm},
                         {"position", json_of(hole.position)},
                         {"curvature_deg", hole.curvature * 180.0 / std::numbers::pi}});
    }
    return {{"name", r.name},         {"vertices", r.vertices},   {"triangles", r.triangles},
            {"area_mm2", r.area_mm2}, {"border_mm", r.border_mm}, {"holes", std::move(holes)}};
}

static Json file_json(const Inspection& found) {
    Json groups = Json::array();
    for (const NamedFaces& group : found.groups)
        groups.push_back({{"names", group.names}, {"triangles", group.triangles}});
    return {{"vertices", found.file_vertices},
            {"triangles", found.file_triangles},
            {"groups", std::move(groups)},
            {"unit_mm", found.unit_mm}};
}

static Json surface_json(const Inspection& found) {
    Json loops = Json::array(), positions = Json::array();
    for (const BorderLoop& loop : found.border_loops) {
        loops.push_back(loop.length_mm);
        positions.push_back(json_of(loop.position));
    }
    return {{"vertices", found.vertices},          {"triangles", found.triangles},
            {"components", found.components},      {"closed", found.border_loops.empty()},
            {"border_loops_mm", std::move(loops)}, {"border_positions", std::move(positions)},
            {"area_mm2", found.area_mm2},          {"size_mm", json_of(found.size_mm)}};
}

std::string to_json(const Inspection& found, int indent) {
    Json regions = Json::array();
    for (const InspectedRegion& r : found.regions) regions.push_back(region_json(r));
    Json report{{"flattens", !found.fault},
                {"file", file_json(found)},
                {"surface", surface_json(found)},
                {"regions", std::move(regions)},
                {"warnings", json_of(found.warnings)},
                {"repairs", json_of(found.repairs)}};
    if (found.plan.landmarks) report["found"] = json_of(found.plan);
    if (found.fault) report["problem"] = json_of(problem_of(*found.fault));
    return text_of(report, indent);
}

}  // namespace lastflat::api
