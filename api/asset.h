// A model that was sent before, as it stands on the wire.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lastflat::api {

struct Asset {
    std::string digest;  ///< SHA-256 of the bytes, and its id
    std::uint64_t bytes = 0;
    std::int64_t created_ms = 0;  ///< since 1970
};

[[nodiscard]] std::string to_json(const Asset& asset);
[[nodiscard]] std::string to_json(const std::vector<Asset>& assets);

}  // namespace lastflat::api
