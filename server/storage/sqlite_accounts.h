// Assets and keys in SQLite.
#pragma once

#include "server/jobs/asset_store.h"
#include "server/jobs/key_store.h"
#include "server/storage/sqlite.h"

namespace lastflat::server {

class SqliteAssets final : public AssetStore {
public:
    /// The database must outlive the store.
    explicit SqliteAssets(SqliteDatabase& database) : database_(database) {}
    [[nodiscard]] AssetAdmission add(const std::string& owner, const std::string& digest,
                                     std::uint64_t bytes, const AssetLimits& limits) override;
    [[nodiscard]] std::optional<Asset> find(const std::string& owner,
                                            const std::string& digest) override;
    [[nodiscard]] std::vector<Asset> list(const std::string& owner) override;
    [[nodiscard]] bool remove(const std::string& owner, const std::string& digest) override;

private:
    SqliteDatabase& database_;
};

class SqliteKeys final : public KeyStore {
public:
    explicit SqliteKeys(SqliteDatabase& database) : database_(database) {}
    [[nodiscard]] std::string add(const NewKey& key) override;
    [[nodiscard]] bool revoke(const std::string& id) override;
    [[nodiscard]] std::vector<ApiKey> list() override;
    [[nodiscard]] std::optional<GoodKey> check(std::string_view key) override;
    [[nodiscard]] bool is_good(const std::string& id) override;
    [[nodiscard]] bool has_keys() override;
    [[nodiscard]] std::string secret(const std::string& name) override;

private:
    SqliteDatabase& database_;
};

}  // namespace lastflat::server
