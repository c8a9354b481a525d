#include "server/worker/problem_map.h"

namespace lastflat::server {
namespace {

int status_of(ErrorCode code) {
    switch (code) {  // no default: -Wswitch reports a code without a status
        case ErrorCode::unsupported_model: return 415;
        case ErrorCode::model_too_large: return 413;
        case ErrorCode::unreadable_model:
        case ErrorCode::mesh_not_manifold:
        case ErrorCode::mesh_not_oriented:
        case ErrorCode::mesh_degenerate:
        case ErrorCode::group_not_found:
        case ErrorCode::curve_invalid:
        case ErrorCode::region_invalid:
        case ErrorCode::region_not_disk:
        case ErrorCode::method_failed:
        case ErrorCode::constraints_infeasible:
        case ErrorCode::border_crosses:
        case ErrorCode::unsupported_request: return 422;
        case ErrorCode::cancelled: return 409;
        case ErrorCode::solver_failed: return 500;
    }
    return 500;
}

}  // namespace

api::Problem problem_of(const Error& error) {
    api::Problem problem;
    problem.status = status_of(error.code());
    problem.code = name(error.code());
    problem.detail = error.what();
    problem.pointer = error.option();
    if (const auto& p = error.position()) problem.position = {p->x(), p->y(), p->z()};
    problem.triangles = error.triangles();
    for (const ConflictMember& member : error.conflict()) {
        const Vec3& p = member.position;
        problem.conflict.push_back(
            {member.option, member.title, member.off_mm, {p.x(), p.y(), p.z()}});
    }
    return problem;
}

api::Problem problem_of(const api::InvalidRequest& error) {
    const std::string field = error.pointer().empty() ? "the request" : error.pointer();
    return {422, "invalid_request", "", field + ": " + error.what(), error.pointer(), std::nullopt};
}

api::Problem out_of_memory() {
    return {413,          "out_of_memory",
            "",           "the model needs more memory than a job may have; send a coarser one",
            std::nullopt, std::nullopt};
}

}  // namespace lastflat::server
