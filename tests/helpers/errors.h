// What a call is refused with, as text that a test can look into.
#pragma once

#include <string>

#include "core/error.h"
#include "core/load/load_model.h"

namespace lastflat::test {

/// "code option: message", or "no error".
template <class Call>
std::string error_of(const Call& call) {
    try {
        call();
    } catch (const Error& error) {
        const std::string option = error.option() ? " " + *error.option() : "";
        return std::string(name(error.code())) + option + ": " + error.what();
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
