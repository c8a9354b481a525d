// What a key or a token may do.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/jobs/key_store.h"

namespace lastflat::server {

struct Grant {
    enum class Kind {
        all,
        jobs,    ///< all but deleting, webhooks and tokens
        read,    ///< looking and mapping
        submit,  ///< making jobs and assets and nothing else
        job,     ///< reading one job, mapping on its result
        asset    ///< making jobs of one asset, reading and canceling those
    };
    Kind kind = Kind::all;
    std::string id{};  ///< of the job or asset
};

[[nodiscard]] Grant grant_of(KeyScope scope);

/// The model of a job of the one who asks; empty: there is no such job.
using ModelOfJob = std::function<std::string(const std::string& id)>;

/// Whether the request may be made. What a submission names is not seen here (`Grant::asset`).
[[nodiscard]] bool allows(const Grant& grant, std::string_view method, std::string_view path,
                          const ModelOfJob& model_of_job);

/// What a token says; it is signed and cannot be changed.
struct TokenClaims {
    std::string key;    ///< id of the key that made it; empty: the service was open
    std::string scope;  ///< "submit", "job:ID", "asset:ID"
    std::int64_t expires_ms = 0;
    std::vector<std::string> origins{};
};

/// Signs and reads tokens; nothing of them is kept.
class Tokens {
public:
    explicit Tokens(std::string secret) : secret_(std::move(secret)) {}

    static constexpr std::string_view prefix = "lastflat_token_";

    [[nodiscard]] std::string sealed(const TokenClaims& claims) const;
    /// Nothing if we did not sign it, or its time is over.
    [[nodiscard]] std::optional<TokenClaims> opened(std::string_view token) const;
    [[nodiscard]] static Grant grant_of(const TokenClaims& claims);

private:
    const std::string secret_;
};

}  // namespace lastflat::server
