// Points and lines from the last to its pattern and back.
#pragma once

#include <string>

#include "api/map.h"

namespace lastflat::server {

/// `flat_obj`: the pieces, as a result's OBJ. Lines come back with points a millimetre apart.
/// Throws: Error.
[[nodiscard]] api::Mapped map_job(const std::string& flat_obj, const api::MapRequest& request);

}  // namespace lastflat::server
