// What a call is refused with, as text that a test can look into.
#pragma once

#include <string>

#include "api/problem_of.h"
#include "core/error.h"
#include "core/load/load_model.h"

namespace lastflat::test {

/// "code option: message", or "no error".
template <class Call>
std::string error_of(const Call& call) {
    try {
        call();
    } catch (const Error& error) {
        const api::Problem problem = api::problem_of(error);
        const std::string option = problem.pointer ? " " + *problem.pointer : "";
        return std::string(problem.code.word()) + option + ": " + problem.detail;
    }
    return "no error";
}

inline std::string load_error(std::string_view model, const LoadLimits& limits = {}) {
    return error_of([&] { (void)load_model(model, limits); });
}

inline bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace lastflat::test
