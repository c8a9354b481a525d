// Where a face of the surface comes from.
#pragma once

#include <cstdint>

#include "core/numerics/types.h"

namespace lastflat {

struct FaceOrigin {
    std::uint32_t label;  ///< of `RawMesh::label_sets`
    Index triangle;       ///< of the file, in its order; -1: made to fill a hole or an opening

    [[nodiscard]] FaceOrigin filling_beside() const { return {label, -1}; }
};

}  // namespace lastflat
