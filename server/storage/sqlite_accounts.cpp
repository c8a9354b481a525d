#include "server/storage/sqlite_accounts.h"

#include "server/storage/sqlite_rows.h"
#include "server/support/clock.h"
#include "server/support/crypto.h"

namespace lastflat::server {
namespace {

constexpr std::string_view key_prefix = "lastflat_";
constexpr std::size_t id_bytes = 6, secret_bytes = 32;

}  // namespace

AssetAdmission SqliteAssets::add(const std::string& owner, const std::string& digest,
                                 std::uint64_t bytes, const AssetLimits& limits) {
    return database_.write([&](SqliteConnection& connection) {
        Query known(connection.prepared("SELECT 1 FROM assets WHERE owner = ? AND digest = ?"));
        if (known.bind(owner, digest).next()) return AssetAdmission::known;
        Query used(connection.prepared(
            "SELECT COUNT(*), COALESCE(SUM(bytes), 0) FROM assets WHERE owner = ?"));
        if (used.bind(owner).next() &&
            (static_cast<std::size_t>(used.number(0)) >= limits.count ||
             static_cast<std::uint64_t>(used.number(1)) + bytes > limits.bytes))
            return AssetAdmission::full;
        if (!owner.empty() && bytes_kept(connection, owner) + bytes > limits.bytes_of_owner)
            return AssetAdmission::storage_full;
        Query(connection.prepared("INSERT INTO assets VALUES (?, ?, ?, ?)"))
            .bind(owner, digest, bytes, now_ms())
            .run();
        return AssetAdmission::added;
    });
}

std::vector<Asset> SqliteAssets::list(const std::string& owner) {
    return database_.read([&](SqliteConnection& connection) {
        Query query(
            connection.prepared("SELECT digest, bytes, created_ms FROM assets "
                                "WHERE owner = ? ORDER BY created_ms DESC, digest"));
        query.bind(owner);
        std::vector<Asset> assets;
        while (query.next()) {
            assets.push_back(
                {query.text(0), static_cast<std::uint64_t>(query.number(1)), query.number(2)});
        }
        return assets;
    });
}

std::optional<Asset> SqliteAssets::find(const std::string& owner, const std::string& digest) {
    return database_.read([&](SqliteConnection& connection) -> std::optional<Asset> {
        Query query(connection.prepared(
            "SELECT digest, bytes, created_ms FROM assets WHERE owner = ? AND digest = ?"));
        if (!query.bind(owner, digest).next()) return std::nullopt;
        return Asset{query.text(0), static_cast<std::uint64_t>(query.number(1)), query.number(2)};
    });
}

bool SqliteAssets::remove(const std::string& owner, const std::string& digest) {
    return database_.write([&](SqliteConnection& connection) {
        return Query(connection.prepared("DELETE FROM assets WHERE owner = ? AND digest = ?"))
                   .bind(owner, digest)
                   .run() > 0;
    });
}

std::string SqliteKeys::add(const std::string& name) {
    const std::string id = hexadecimal(random_bytes(id_bytes));
    std::string key = std::string(key_prefix) + id + "_" + hexadecimal(random_bytes(secret_bytes));
    database_.write([&](SqliteConnection& connection) {
        Query(connection.prepared("INSERT INTO keys VALUES (?, ?, ?, ?, NULL)"))
            .bind(id, name, sha256(key), now_ms())
            .run();
    });
    return key;
}

bool SqliteKeys::revoke(const std::string& id) {
    return database_.write([&](SqliteConnection& connection) {
        return Query(connection.prepared(
                         "UPDATE keys SET revoked_ms = ? WHERE id = ? AND revoked_ms IS NULL"))
                   .bind(now_ms(), id)
                   .run() > 0;
    });
}

std::vector<ApiKey> SqliteKeys::list() {
    return database_.read([](SqliteConnection& connection) {
        Query query(connection.prepared(
            "SELECT id, name, created_ms, revoked_ms FROM keys ORDER BY created_ms"));
        std::vector<ApiKey> keys;
        while (query.next()) {
            keys.push_back({query.text(0), query.text(1), query.number(2), query.maybe_number(3)});
        }
        return keys;
    });
}

std::optional<std::string> SqliteKeys::check(std::string_view key) {
    if (key.substr(0, key_prefix.size()) != key_prefix) return std::nullopt;
    const std::string id(key.substr(key_prefix.size(), 2 * id_bytes));
    const std::string hash = sha256(key);
    return database_.read([&](SqliteConnection& connection) -> std::optional<std::string> {
        Query query(
            connection.prepared("SELECT hash FROM keys WHERE id = ? AND revoked_ms IS NULL"));
        if (!query.bind(id).next() || !equal_in_constant_time(query.text(0), hash))
            return std::nullopt;
        return id;
    });
}

bool SqliteKeys::has_keys() {
    return database_.read([](SqliteConnection& connection) {
        Query query(connection.prepared("SELECT 1 FROM keys LIMIT 1"));
        return query.next();
    });
}

std::string SqliteKeys::secret(const std::string& name) {
    return database_.write([&](SqliteConnection& connection) {
        Query(connection.prepared("INSERT OR IGNORE INTO secrets VALUES (?, ?)"))
            .bind(name, hexadecimal(random_bytes(secret_bytes)))
            .run();
        Query query(connection.prepared("SELECT value FROM secrets WHERE name = ?"));
        if (!query.bind(name).next()) throw StoreError("a secret was not kept");
        return query.text(0);
    });
}

}  // namespace lastflat::server
