// API keys, hashed, and the service's own secrets.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/words.h"

namespace lastflat::server {

/// What a key may do: everything; work with jobs and models, but delete nothing, have no webhooks
/// and make no tokens; look.
enum class KeyScope { all, jobs, read };
inline constexpr api::Word<KeyScope> key_scopes[] = {
    {"all", KeyScope::all}, {"jobs", KeyScope::jobs}, {"read", KeyScope::read}};

struct NewKey {
    std::string name;
    KeyScope scope = KeyScope::all;
    std::optional<std::int64_t> expires_ms{};
};

struct ApiKey : NewKey {
    std::string id;
    std::int64_t created_ms = 0;
    std::optional<std::int64_t> revoked_ms;
};

struct GoodKey {
    std::string id;
    KeyScope scope;
};

/// Every call is safe from any thread and may throw StoreError.
class KeyStore {
public:
    virtual ~KeyStore() = default;
    /// Makes a key and returns it as the client sends it; it cannot be read again.
    [[nodiscard]] virtual std::string add(const NewKey& key) = 0;
    /// False: there is no such key, or it was revoked before.
    [[nodiscard]] virtual bool revoke(const std::string& id) = 0;
    [[nodiscard]] virtual std::vector<ApiKey> list() = 0;
    /// The key if it is good: neither revoked nor past its time.
    [[nodiscard]] virtual std::optional<GoodKey> check(std::string_view key) = 0;
    /// Whether the key of this id is.
    [[nodiscard]] virtual bool is_good(const std::string& id) = 0;
    /// Whether a key was ever made, revoked or not: a service that had keys is never open again.
    [[nodiscard]] virtual bool has_keys() = 0;
    /// 32 random bytes that stay the same from the first call on, in hexadecimal digits.
    [[nodiscard]] virtual std::string secret(const std::string& name) = 0;
};

}  // namespace lastflat::server
