// Models that clients have left here to be flattened many times.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "api/asset.h"

namespace lastflat::server {

using api::Asset;

struct AssetLimits {
    std::uint64_t bytes = 4ULL << 30;  ///< of one owner
    std::size_t count = 10'000;
    std::uint64_t bytes_of_owner = 16ULL << 30;  ///< with models and results
};

enum class AssetAdmission { added, known, full, storage_full };

/// Every call is safe from any thread and may throw StoreError.
class AssetStore {
public:
    virtual ~AssetStore() = default;
    /// `full`, `storage_full`: with it the owner would have more than the limits (assets; all that
    /// it keeps), so it was not added.
    [[nodiscard]] virtual AssetAdmission add(const std::string& owner, const std::string& digest,
                                             std::uint64_t bytes, const AssetLimits& limits) = 0;
    [[nodiscard]] virtual std::optional<Asset> find(const std::string& owner,
                                                    const std::string& digest) = 0;
    /// Newest first.
    [[nodiscard]] virtual std::vector<Asset> list(const std::string& owner) = 0;
    [[nodiscard]] virtual bool remove(const std::string& owner, const std::string& digest) = 0;
};

}  // namespace lastflat::server
