// What the service says of its own state.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "api/words.h"

namespace lastflat::api {

enum class Status { ok, ready, draining, store_unavailable };
inline constexpr Word<Status> statuses[] = {{"ok", Status::ok},
                                            {"ready", Status::ready},
                                            {"draining", Status::draining},
                                            {"store_unavailable", Status::store_unavailable}};

struct Health {
    struct Jobs {
        std::size_t queued, running;
    };
    Status status = Status::ok;
    std::string version{};  ///< empty: is not said
    std::optional<Jobs> jobs{};
};
[[nodiscard]] std::string to_json(const Health& health);

/// The body of GET /version.
[[nodiscard]] std::string version_json(const std::string& version);

}  // namespace lastflat::api
