// How a command says what is wrong.
#pragma once

#include "api/problem.h"

namespace lastflat::server {

enum class Audience { people, programs };

/// On standard error: to people a sentence, to programs the problem document. Returns the exit
/// code: 2 if the input is at fault, 1 if anything else is.
[[nodiscard]] int complain(const api::Problem& problem, Audience audience);

}  // namespace lastflat::server
