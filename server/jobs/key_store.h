// API keys, hashed, and the service's own secrets.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lastflat::server {

struct ApiKey {
    std::string id, name;
    std::int64_t created_ms = 0;
    std::optional<std::int64_t> revoked_ms;
};

/// Every call is safe from any thread and may throw StoreError.
class KeyStore {
public:
    virtual ~KeyStore() = default;
    /// Makes a key and returns it as the client sends it; it cannot be read again.
    [[nodiscard]] virtual std::string add(const std::string& name) = 0;
    /// False: there is no such key, or it was revoked before.
    [[nodiscard]] virtual bool revoke(const std::string& id) = 0;
    [[nodiscard]] virtual std::vector<ApiKey> list() = 0;
    /// The id of the key if it is good.
    [[nodiscard]] virtual std::optional<std::string> check(std::string_view key) = 0;
    /// Whether a key was ever made, revoked or not: a service that had keys is never open again.
    [[nodiscard]] virtual bool has_keys() = 0;
    /// 32 random bytes that stay the same from the first call on, in hexadecimal digits.
    [[nodiscard]] virtual std::string secret(const std::string& name) = 0;
};

}  // namespace lastflat::server
