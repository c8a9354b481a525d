#include "server/worker/inspect_job.h"

#include <numbers>

#include "api/json.h"
#include "api/problem_json.h"
#include "core/inspect.h"
#include "server/worker/problem_map.h"

namespace lastflat::server {
namespace {

using Json = nlohmann::ordered_json;

Json position_json(const Vec3& p) {
    return {p.x(), p.y(), p.z()};
}

Json region_json(const InspectedRegion& r) {
    Json holes = Json::array();
    for (const InspectedHole& hole : r.holes) {
        holes.push_back({{"length_mm", hole.length_mm},
                         {"position", position_json(hole.position)},
                         {"curvature_deg", hole.curvature * 180.0 / std::numbers::pi}});
    }
    return {{"name", r.name},         {"vertices", r.vertices},   {"triangles", r.triangles},
            {"area_mm2", r.area_mm2}, {"border_mm", r.border_mm}, {"holes", std::move(holes)}};
}

Json report_json(const Inspection& found) {
    Json groups = Json::array(), regions = Json::array(), warnings = Json::array();
    for (const auto& [name, triangles] : found.groups)
        groups.push_back({{"name", name}, {"triangles", triangles}});
    for (const InspectedRegion& r : found.regions) regions.push_back(region_json(r));
    for (const Warning& w : found.warnings) {
        warnings.push_back({{"code", w.code}, {"detail", w.detail}});
        if (w.position) warnings.back()["position"] = position_json(*w.position);
    }
    Json loops = Json::array(), places = Json::array();
    for (const BorderLoop& loop : found.border_loops) {
        loops.push_back(loop.length_mm);
        places.push_back(position_json(loop.position));
    }
    Json report{{"flattens", !found.fault},
                {"file",
                 {{"vertices", found.file_vertices},
                  {"triangles", found.file_triangles},
                  {"groups", std::move(groups)},
                  {"unit_mm", found.unit_mm}}},
                {"surface",
                 {{"vertices", found.vertices},
                  {"triangles", found.triangles},
                  {"components", found.components},
                  {"closed", found.border_loops.empty()},
                  {"border_loops_mm", std::move(loops)},
                  {"border_positions", std::move(places)},
                  {"area_mm2", found.area_mm2},
                  {"size_mm", position_json(found.size_mm)}}},
                {"regions", std::move(regions)},
                {"warnings", std::move(warnings)},
                {"repairs", api::json_of(found.repairs)}};
    if (found.plan.landmarks) report["found"] = api::json_of(found.plan);
    if (found.fault) report["problem"] = api::problem_json(problem_of(*found.fault));
    return report;
}

}  // namespace

Json inspect_job(const JobInput& input) {
    try {
        return {{"report", report_json(inspect(input.model, input.options))}};
    } catch (const Error& error) {
        return {{"problem", api::problem_json(problem_of(error))}};
    } catch (const std::bad_alloc&) {
        return {{"problem", api::problem_json(out_of_memory())}};
    }
}

}  // namespace lastflat::server
