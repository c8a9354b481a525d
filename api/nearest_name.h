// What may have been meant by a misspelt word.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lastflat::api {

/// The name that is nearest to the word: by letters that are missing, too many, wrong or exchanged
/// with their neighbour, at most one for each three of the word. Nothing: none is near.
[[nodiscard]] std::optional<std::string> nearest_name(std::string_view word,
                                                      const std::vector<std::string>& names);

/// "; did you mean 'keep'?", or nothing.
[[nodiscard]] std::string suggestion(std::string_view word, const std::vector<std::string>& names);

}  // namespace lastflat::api
