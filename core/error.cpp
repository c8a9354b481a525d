#include "core/error.h"

#include "core/text.h"

namespace lastflat {

std::string position_text(const Vec3& position) {
    return fixed_text(position.x(), 1) + ' ' + fixed_text(position.y(), 1) + ' ' +
           fixed_text(position.z(), 1);
}

}  // namespace lastflat
