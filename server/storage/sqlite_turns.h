// Owners take turns, so that nobody waits behind what somebody else has queued.
#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "server/storage/sqlite.h"

namespace lastflat::server {

/// An owner is about to have a job. Who was away has saved nothing up: it begins where the least of
/// the others stands.
void enter_job_turns(SqliteConnection& connection, const std::string& owner);
/// The owner who is served next, of those with something that may be claimed: who has the fewest in
/// work, and among those who has used workers least. Notes the turn.
[[nodiscard]] std::optional<std::string> take_job_turn(SqliteConnection& connection);
/// Notes that a job has kept a worker for so long.
void charge_job_turn(SqliteConnection& connection, const std::string& owner, std::int64_t used_ms);
/// The owner whose message to a webhook is next: who has the fewest on the way, and among those
/// whose last turn is longest ago. Nobody has more than `most` of them on the way.
[[nodiscard]] std::optional<std::string> take_delivery_turn(SqliteConnection& connection, int most);

/// The places of queued jobs, from 1, if everybody's jobs take equally long.
class QueueOrder {
public:
    /// Reads the whole queue.
    explicit QueueOrder(SqliteConnection& connection);
    /// 0: it does not wait.
    [[nodiscard]] std::size_t position_of(std::int64_t job) const;

private:
    struct Place {
        std::size_t owner = 0, place = 0;
    };
    std::vector<std::size_t> waiting_;  ///< how many jobs each owner has
    std::unordered_map<std::int64_t, Place> places_;
};
/// The same for one job.
[[nodiscard]] std::size_t queue_position_of(SqliteConnection& connection, std::int64_t job);

}  // namespace lastflat::server
