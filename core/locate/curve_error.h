// How curves are refused.
#pragma once

#include <string>

#include "core/error.h"

namespace lastflat {

/// Throws: Error{curve_invalid} naming the curve, the field, and the item if there is one.
[[noreturn]] inline void fail_curve(const std::string& curve, const std::string& field,
                                    std::optional<std::size_t> item, const std::string& what,
                                    const std::optional<Vec3>& position = std::nullopt) {
    std::vector<std::string> path{"curves", curve, field};
    if (item) path.push_back(std::to_string(*item));
    Error error(ErrorCode::curve_invalid,
                "curve '" + curve + "'" +
                    (item ? ", item " + std::to_string(*item) : std::string()) + ": " + what);
    error.at_option(path);
    if (position) error.at_position(*position);
    throw error;
}

}  // namespace lastflat
