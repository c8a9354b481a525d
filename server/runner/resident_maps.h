// Patterns that somebody maps on, each in memory for a while.
#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <string>

#include "server/runner/live_sessions.h"

namespace lastflat::server {

/// Safe from any thread.
class ResidentMaps {
public:
    /// `work`: a folder for the patterns.
    ResidentMaps(const ProcessLimits& limits, std::filesystem::path work);

    /// What is mapped, JSON. `pattern`: the result's OBJ, read only if it is not in memory under
    /// this digest; then the one that was asked for longest ago goes.
    /// Throws: api::Refusal, as the mapping, or 500 if its process ends.
    [[nodiscard]] std::string map(const std::string& digest,
                                  const std::function<std::string()>& pattern,
                                  const std::string& request);
    void stop() { live_.stop(); }

private:
    [[nodiscard]] std::shared_ptr<LiveSession> find(const std::string& digest);
    [[nodiscard]] std::shared_ptr<LiveSession> open(const std::string& digest,
                                                    const std::function<std::string()>& pattern);

    LiveSessions live_;  ///< a session's owner is its pattern's digest
    std::mutex opening_;
};

}  // namespace lastflat::server
