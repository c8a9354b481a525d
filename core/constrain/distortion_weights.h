// Where distortion matters more.
#pragma once

#include "core/cut/region.h"
#include "core/request.h"

namespace lastflat {

/// Per triangle the product of the weights of the zones that it is in, 0.001 to 1000.
[[nodiscard]] std::vector<double> triangle_weights(const Region& region,
                                                   const std::vector<Zone>& zones);

}  // namespace lastflat
