// Models that clients have left here to be flattened many times.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace lastflat::server {

struct Asset {
    std::string digest;  ///< SHA-256 of the bytes, and its name
    std::uint64_t bytes = 0;
    std::int64_t created_ms = 0;
};

/// Every call is safe from any thread and may throw StoreError.
class AssetStore {
public:
    virtual ~AssetStore() = default;
    /// True: it is new; false: the owner had it already.
    [[nodiscard]] virtual bool add(const std::string& owner, const std::string& digest,
                                   std::uint64_t bytes) = 0;
    [[nodiscard]] virtual std::optional<Asset> find(const std::string& owner,
                                                    const std::string& digest) = 0;
    [[nodiscard]] virtual bool remove(const std::string& owner, const std::string& digest) = 0;
};

}  // namespace lastflat::server
