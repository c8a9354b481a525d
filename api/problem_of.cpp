#include "api/problem_of.h"

#include <new>

#include "api/object_reader.h"

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
        case ErrorCode::distortion_extreme: return "distortion_extreme";
        case ErrorCode::border_crosses: return "border_crosses";
        case ErrorCode::solver_failed: return "solver_failed";
        case ErrorCode::unsupported_request: return "unsupported_request";
        case ErrorCode::canceled: return "canceled";
    }
    return "internal_error";
}

/// Which field of the request would mend an error at an option, or a warning.
struct Hint {
    ErrorCode code;
    std::string_view pointer;
    const char* text;
};
constexpr Hint hints[] = {
    {ErrorCode::region_not_disk, "/holes", ", or keep them with \"holes\": \"keep\""},
    {ErrorCode::region_invalid, "/regions", "; name those that are meant in \"regions\""},
    {ErrorCode::method_failed, "/method", "; use the method \"isometric\", which never folds"},
};
constexpr Word<const char*> warning_hints[] = {
    {"piece_left_out", "; name it in \"regions\" if it is wanted"},
    {"seam_added", ", or keep it with \"holes\": \"keep\""},
    {"unit_assumed", ". Send \"units\" to be sure"},
    {"size_unusual", ". Send \"units\" to be sure"}};
constexpr char conflict_hint[] = "; leave one out or let it give way (\"on_conflict\": \"relax\")";

std::string hint_for(const Error& error, const std::string& pointer) {
    if (!error.conflict().empty()) return conflict_hint;
    for (const Hint& hint : hints) {
        if (hint.code == error.code() && hint.pointer == pointer) return hint.text;
    }
    return {};
}

std::array<double, 3> wire(const Vec3& p) {
    return {p.x(), p.y(), p.z()};
}

}  // namespace

std::string json_pointer(const std::vector<std::string>& path) {
    std::string pointer;
    for (const std::string& name : path) pointer = step(pointer, name);
    return pointer;
}

Problem problem_of(const Error& error) {
    Problem problem(code_of(error.code()), error.what());
    if (error.option()) {
        problem.pointer = json_pointer(*error.option());
        problem.detail += hint_for(error, *problem.pointer);
    }
    if (error.position()) problem.position = wire(*error.position());
    problem.triangles = error.triangles();
    for (const lastflat::ConflictMember& member : error.conflict()) {
        problem.conflict.push_back(
            {json_pointer(member.option), member.title, member.off_mm, wire(member.position)});
    }
    return problem;
}

std::string detail_of(const Warning& warning) {
    return warning.detail + value_of(warning_hints, warning.code).value_or("");
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
