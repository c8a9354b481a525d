#include "api/problem.h"

#include "api/problem_json.h"

namespace lastflat::api {

nlohmann::ordered_json problem_json(const Problem& problem) {
    std::string title = problem.title;
    if (title.empty()) {
        title = problem.code;
        for (char& c : title) {
            if (c == '_') c = ' ';
        }
    }
    nlohmann::ordered_json json{{"type", "urn:lastflat:problem:" + problem.code},
                                {"title", title},
                                {"status", problem.status},
                                {"detail", problem.detail},
                                {"code", problem.code}};
    if (problem.pointer) json["pointer"] = *problem.pointer;
    if (problem.position) json["position"] = *problem.position;
    if (!problem.triangles.empty()) json["triangles"] = problem.triangles;
    for (const ConflictMember& member : problem.conflict) {
        json["conflict"].push_back({{"pointer", member.pointer},
                                    {"title", member.title},
                                    {"off_mm", member.off_mm},
                                    {"position", member.position}});
    }
    return json;
}

std::string to_json(const Problem& problem) {
    return problem_json(problem).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace lastflat::api
