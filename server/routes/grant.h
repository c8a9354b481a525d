// What a key or a token may do.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "server/jobs/key_store.h"

namespace lastflat::server {

struct Grant {
    enum class Kind {
        all,
        jobs,    ///< all but deleting, webhooks and tokens
        read,    ///< looking and mapping, but not at webhooks
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

}  // namespace lastflat::server
