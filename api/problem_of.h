// Why something failed, in the words of the wire: the only way from an exception to a problem.
#pragma once

#include <exception>
#include <string>
#include <vector>

#include "api/refusal.h"
#include "core/error.h"

namespace lastflat::api {

/// What was thrown, with its problem: a `Refusal` as it is; of an `Error` of core its code, with a
/// hint where a field of the request would mend it; of std::bad_alloc `out_of_memory`; of anything
/// else `internal_error`. Its `what()` is for the operator.
[[nodiscard]] Refusal refusal_of(const std::exception_ptr& thrown);
[[nodiscard]] inline Problem problem_of(const std::exception_ptr& thrown) {
    return refusal_of(thrown).problem();
}
[[nodiscard]] Problem problem_of(const Error& error);
/// The detail of a warning of core, with its hint.
[[nodiscard]] std::string detail_of(const Warning& warning);

/// A path of options as a JSON pointer (RFC 6901), such as "/curves/heel/vertices/12".
[[nodiscard]] std::string json_pointer(const std::vector<std::string>& path);

}  // namespace lastflat::api
