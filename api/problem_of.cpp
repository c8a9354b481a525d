#include "api/problem_of.h"

#include <new>

namespace lastflat::api {
namespace {

ProblemCode code_of(ErrorCode code) {
    switch (code) {  // no default: -Wswitch reports a code without a line in the catalogue
        case ErrorCode::unreadable_model: return "unreadable_model";
        case ErrorCode::unsupported_model: return "unsupported_model";
        case ErrorCode::model_too_large: return "model_too_large";
        case ErrorCode::mesh_not_manifold: return "mesh_not_manifold";
        case ErrorCode::mesh_not_oriented: return "mesh_not_oriented";
        case ErrorCode::mesh_degenerate: return "mesh_degenerate";
        case ErrorCode::group_not_found: return "group_not_found";
        case ErrorCode::curve_invalid: return "curve_invalid";
        case ErrorCode::region_invalid: return "region_invalid";
        case ErrorCode::region_not_disk: return "region_not_disk";
        case ErrorCode::method_failed: return "method_failed";
        case ErrorCode::constraints_infeasible: return "constraints_infeasible";
        case ErrorCode::border_crosses: return "border_crosses";
        case ErrorCode::solver_failed: return "solver_failed";
        case ErrorCode::unsupported_request: return "unsupported_request";
        case ErrorCode::cancelled: return "canceled";
    }
    return "internal_error";
}

std::array<double, 3> wire(const Vec3& p) {
    return {p.x(), p.y(), p.z()};
}

}  // namespace

Problem problem_of(const Error& error) {
    Problem problem(code_of(error.code()), error.what());
    problem.pointer = error.option();
    if (error.position()) problem.position = wire(*error.position());
    problem.triangles = error.triangles();
    for (const lastflat::ConflictMember& member : error.conflict()) {
        problem.conflict.push_back(
            {member.option, member.title, member.off_mm, wire(member.position)});
    }
    return problem;
}

Refusal refusal_of(const std::exception_ptr& thrown) {
    const auto internal = [](const std::string& what) {
        return Refusal({"internal_error", "an internal error: " + what}, what);
    };
    try {
        std::rethrow_exception(thrown);
    } catch (const Refusal& refusal) {
        return refusal;
    } catch (const Error& error) {
        return Refusal(problem_of(error));
    } catch (const std::bad_alloc&) {
        return {"out_of_memory",
                "the model needs more memory than a job may have; send a coarser one"};
    } catch (const std::exception& error) {
        return internal(error.what());
    } catch (...) {
        return internal("an exception of unknown type");
    }
}

}  // namespace lastflat::api
