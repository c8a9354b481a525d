#include "api/problem.h"

#include "api/json.h"

namespace lastflat::api {

Json json_of(const Problem& problem) {
    Json json{{"type", "urn:lastflat:problem:" + std::string(problem.code.word())},
              {"title", problem.code.title()},
              {"status", problem.status},
              {"detail", problem.detail},
              {"code", problem.code.word()}};
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
    return text_of(json_of(problem));
}

Problem problem_from_json(std::string_view text) try {
    const Json json = Json::parse(text);
    Problem problem(ProblemCode::read(json.at("code").get<std::string>()), json.at("detail"));
    json.at("status").get_to(problem.status);
    if (json.contains("pointer")) problem.pointer = json["pointer"];
    if (json.contains("position")) problem.position = json["position"];
    if (json.contains("triangles")) json["triangles"].get_to(problem.triangles);
    if (!json.contains("conflict")) return problem;
    for (const Json& member : json["conflict"]) {
        problem.conflict.push_back(
            {member.at("pointer"), member.at("title"), member.at("off_mm"), member.at("position")});
    }
    return problem;
} catch (const std::exception& error) {
    throw std::runtime_error(std::string("a stored problem cannot be read: ") + error.what());
}

Problem without_result(const Problem& problem) {
    Problem answer(problem.code, "the job failed: " + problem.detail);
    answer.status = 409;
    answer.pointer = problem.pointer;
    answer.position = problem.position;
    return answer;
}

}  // namespace lastflat::api
