// Constraints in short.
#pragma once

#include "core/request.h"

namespace lastflat {

inline Constraint lock(std::string curve, Keep keep = Keep::edges) {
    return {Lock{std::move(curve), keep}};
}

inline Constraint range(std::string curve, double least, double most, std::string region = "") {
    return {Range{std::move(curve), least, most, std::move(region)}};
}

}  // namespace lastflat
