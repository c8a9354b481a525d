// The result for people, at a terminal.
#pragma once

#include <string>

namespace lastflat {
struct FlattenResult;
}

namespace lastflat::api {

/// A table of the curves, lines for pairs and for constraints that are no locks, a table of the
/// strain of the leather, the warnings. Each heading says what its signs mean.
[[nodiscard]] std::string to_table(const FlattenResult& result);

}  // namespace lastflat::api
