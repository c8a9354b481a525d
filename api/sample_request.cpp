#include "api/sample_request.h"

#include "api/json.h"
#include "core/sample/sample_last.h"

namespace lastflat::api {

std::string sample_request(const SampleLast& last) {
    Json curves;
    for (const auto& [name, vertices] : last.curves) curves[name] = {{"vertices", vertices}};
    return text_of({{"surface", {{"groups", {"upper"}}}},
                    {"curves", std::move(curves)},
                    {"cuts", {"centre_front", "heel"}},
                    {"regions",
                     {{"lateral", {{"contains", {{"vertex", last.lateral_vertex}}}}},
                      {"medial", {{"contains", {{"vertex", last.medial_vertex}}}}}}},
                    {"locks", {{{"curve", "centre_front"}}, {{"curve", "heel"}}}},
                    {"method", {{"name", "isometric"}}}}) +
           "\n";
}

}  // namespace lastflat::api
