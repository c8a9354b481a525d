// Constraints in short.
#pragma once

#include "core/request.h"

namespace lastflat {

inline Constraint lock(std::string curve, Keep keep = Keep::edges) {
    return {Lock{std::move(curve), keep}};
}

}  // namespace lastflat
