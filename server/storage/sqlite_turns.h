// Owners take turns, so that nobody waits behind what somebody else has queued.
#pragma once

#include <optional>
#include <string>

#include "server/storage/sqlite.h"

namespace lastflat::server {

/// The owner who is served next, of those with something that may be claimed: who has the fewest in
/// work, and among those whose last turn is longest ago. Notes the turn.
[[nodiscard]] std::optional<std::string> take_job_turn(SqliteConnection& connection);
/// The same for messages to webhooks. Nobody has more than `most` of them on the way.
[[nodiscard]] std::optional<std::string> take_delivery_turn(SqliteConnection& connection, int most);

/// The place of a queued job, from 1, if everybody's jobs take equally long.
[[nodiscard]] std::size_t queue_position_of(SqliteConnection& connection, std::int64_t job);

}  // namespace lastflat::server
