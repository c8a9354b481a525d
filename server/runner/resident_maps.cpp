#include "server/runner/resident_maps.h"

#include "api/refusal.h"

namespace lastflat::server {
namespace {

SessionLimits limits_of(const ProcessLimits& process) {
    constexpr std::size_t most = 4;
    constexpr std::chrono::minutes idle{1};
    return {most, 1, idle, process};
}

}  // namespace

ResidentMaps::ResidentMaps(const ProcessLimits& limits, std::filesystem::path work)
    : live_(limits_of(limits), std::move(work)) {}

std::shared_ptr<LiveSession> ResidentMaps::find(const std::string& digest) {
    for (const SessionEntry& entry : live_.list(digest)) {
        if (!entry.live->is_over()) return live_.find(digest, entry.id).live;
        live_.close(digest, entry.id);
    }
    return nullptr;
}

/// One at a time: others that want the same find it then.
std::shared_ptr<LiveSession> ResidentMaps::open(const std::string& digest,
                                                const std::function<std::string()>& pattern) {
    const std::scoped_lock lock(opening_);
    if (auto live = find(digest)) return live;
    const std::string obj = pattern();
    live_.close_least_used();
    return live_.open(digest, Task::resident_map, obj, "").first.live;
}

std::string ResidentMaps::map(const std::string& digest,
                              const std::function<std::string()>& pattern,
                              const std::string& request) {
    constexpr int attempts = 2;  // others may need its place just when it is asked
    for (int attempt = 0; attempt < attempts; ++attempt) {
        try {
            auto live = find(digest);
            if (!live) live = open(digest, pattern);
            return live->ask({0, AskKind::map, 0, false, request});
        } catch (const api::Refusal& refusal) {
            const std::string_view code = refusal.problem().code.word();
            if (code != "session_lost" && code != "session_not_found") throw;
        }
    }
    api::refuse("worker_crashed", "the program broke on this pattern; the service goes on");
}

}  // namespace lastflat::server
