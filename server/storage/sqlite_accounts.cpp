#include "server/storage/sqlite_accounts.h"

#include "server/storage/sqlite_rows.h"
#include "server/support/clock.h"
#include "server/support/crypto.h"

namespace lastflat::server {
namespace {

constexpr std::string_view key_prefix = "lastflat_";
constexpr std::size_t id_bytes = 6, secret_bytes = 32;

constexpr const char* select_good =
    "SELECT hash, scope FROM keys WHERE id = ? AND revoked_ms IS NULL AND "
    "(expires_ms IS NULL OR expires_ms > ?)";

KeyScope scope_of(const std::string& word) {
    const auto scope = api::value_of(key_scopes, word);
    if (!scope) throw StoreError("the database has a key of the unknown scope '" + word + "'");
    return *scope;
}

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

std::string SqliteKeys::add(const NewKey& made) {
    const std::string id = hexadecimal(random_bytes(id_bytes));
    std::string key = std::string(key_prefix) + id + "_" + hexadecimal(random_bytes(secret_bytes));
    database_.write([&](SqliteConnection& connection) {
        Query(
            connection.prepared("INSERT INTO keys (id, name, hash, created_ms, scope, expires_ms) "
                                "VALUES (?, ?, ?, ?, ?, ?)"))
            .bind(id, made.name, sha256(key), now_ms(), api::word_of(key_scopes, made.scope),
                  made.expires_ms)
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
            "SELECT id, name, created_ms, revoked_ms, scope, expires_ms FROM keys "
            "ORDER BY created_ms"));
        std::vector<ApiKey> keys;
        while (query.next()) {
            keys.push_back({{query.text(1), scope_of(query.text(4)), query.maybe_number(5)},
                            query.text(0),
                            query.number(2),
                            query.maybe_number(3)});
        }
        return keys;
    });
}

std::optional<GoodKey> SqliteKeys::check(std::string_view key) {
    if (key.substr(0, key_prefix.size()) != key_prefix) return std::nullopt;
    const std::string id(key.substr(key_prefix.size(), 2 * id_bytes));
    const std::string hash = sha256(key);
    return database_.read([&](SqliteConnection& connection) -> std::optional<GoodKey> {
        Query query(connection.prepared(select_good));
        if (!query.bind(id, now_ms()).next() || !equal_in_constant_time(query.text(0), hash))
            return std::nullopt;
        return GoodKey{id, scope_of(query.text(1))};
    });
}

bool SqliteKeys::is_good(const std::string& id) {
    return database_.read([&](SqliteConnection& connection) {
        Query query(connection.prepared(select_good));
        return query.bind(id, now_ms()).next();
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
