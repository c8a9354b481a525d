// The only file that knows both the wire's types and core's.
#pragma once

#include "api/flatten_request.h"
#include "api/flatten_result.h"
#include "core/flatten.h"

namespace lastflat::server {

[[nodiscard]] FlattenOptions to_options(const api::FlattenRequest& request);

[[nodiscard]] api::FlattenResult to_wire(const FlattenResult& result);
[[nodiscard]] api::FoundLandmarks to_wire(const Landmarks& found);
[[nodiscard]] std::vector<api::RepairResult> to_wire(const std::vector<Repair>& repairs);

}  // namespace lastflat::server
