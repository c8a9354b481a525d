#include "core/error.h"

#include "core/text.h"

namespace lastflat {

std::string_view name(ErrorCode code) {
    switch (code) {  // no default: -Wswitch reports a code without a name
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
    return "unknown";
}

std::string json_pointer(const std::vector<std::string>& path) {
    std::string pointer;
    for (const std::string& step : path) {
        pointer += '/';
        for (const char c : step) {
            if (c == '~')
                pointer += "~0";
            else if (c == '/')
                pointer += "~1";
            else
                pointer += c;
        }
    }
    return pointer;
}

Error& Error::at_option(const std::vector<std::string>& path) {
    option_ = json_pointer(path);
    return *this;
}

std::string place(const Vec3& position) {
    return fixed_text(position.x(), 1) + ' ' + fixed_text(position.y(), 1) + ' ' +
           fixed_text(position.z(), 1);
}

}  // namespace lastflat
