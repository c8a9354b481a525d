#include "server/worker/inspect_job.h"

#include "api/problem_json.h"
#include "api/report_json.h"
#include "core/inspect.h"
#include "server/problem_map.h"
#include "server/translate.h"

namespace lastflat::server {
namespace {

using Json = nlohmann::ordered_json;

Json report_json(const Inspection& found) {
    Json groups = Json::array(), regions = Json::array(), warnings = Json::array();
    for (const auto& [name, triangles] : found.groups)
        groups.push_back({{"name", name}, {"triangles", triangles}});
    for (const InspectedRegion& r : found.regions) {
        regions.push_back({{"name", r.name},
                           {"vertices", r.vertices},
                           {"triangles", r.triangles},
                           {"area_mm2", r.area_mm2},
                           {"border_mm", r.border_mm}});
    }
    for (const Warning& w : found.warnings) {
        warnings.push_back({{"code", w.code}, {"detail", w.detail}});
        if (w.position) {
            const Vec3& p = *w.position;
            warnings.back()["position"] = {p.x(), p.y(), p.z()};
        }
    }
    const Vec3& size = found.size_mm;
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
                  {"closed", found.border_loops_mm.empty()},
                  {"border_loops_mm", found.border_loops_mm},
                  {"area_mm2", found.area_mm2},
                  {"size_mm", {size.x(), size.y(), size.z()}}}},
                {"regions", std::move(regions)},
                {"warnings", std::move(warnings)},
                {"repairs", api::repairs_json(to_wire(found.repairs))}};
    if (found.landmarks) report["found"] = api::found_json(to_wire(*found.landmarks));
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
