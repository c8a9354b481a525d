// The parts of a request that say what the pattern must keep, and what matters where.
#pragma once

#include "api/flatten_request.h"
#include "api/object_reader.h"

namespace lastflat::api {

/// Reads "locks", "constraints", "on_conflict", "weights" and "material".
/// Points that they name must have been read before.
void read_constraint_fields(ObjectReader& reader, const RequestLimits& limits, Request& request);

/// `exterior` and `interior` are read as `lateral` and `medial`.
[[nodiscard]] std::string canonical_region(const std::string& name);

}  // namespace lastflat::api
