// The live sessions of the service: who has which, and until when.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "server/runner/live_session.h"

namespace lastflat::server {

struct SessionLimits {
    std::size_t all = 8, per_owner = 2;
    std::chrono::milliseconds idle{600'000};  ///< without being asked
    ProcessLimits process{};
};

/// One of them. Its model lies in a file for as long as it lives.
struct SessionEntry {
    std::string id, owner;
    std::filesystem::path model;
    std::int64_t created_ms = 0, used_ms = 0;
    std::shared_ptr<LiveSession> live{};
};

/// Beside the pool of jobs, each with a process of its own, in memory alone. Safe from any thread.
class LiveSessions {
public:
    /// `work`: a folder for the models.
    LiveSessions(const SessionLimits& limits, std::filesystem::path work);
    /// Ends all of them.
    ~LiveSessions();

    /// Starts one, a session or a resident map; if it does not open, there is none. Returns what it
    /// opened with, too.
    /// Throws: api::Refusal: 429, 503 if there are as many as may be; what the model or the request
    /// are refused with; StoreError.
    [[nodiscard]] std::pair<SessionEntry, std::string> open(const std::string& owner, Task task,
                                                            std::string_view model,
                                                            const std::string& request);
    /// It counts as used. Throws: api::Refusal (404).
    [[nodiscard]] SessionEntry find(const std::string& owner, const std::string& id);
    [[nodiscard]] std::vector<SessionEntry> list(const std::string& owner);
    /// Throws as `find`.
    void close(const std::string& owner, const std::string& id);
    /// Makes room for one, if there is none: the one goes that was asked for longest ago.
    void close_least_used();
    /// Ends all of them, and takes no more.
    void stop();

    [[nodiscard]] std::int64_t expires_ms(const SessionEntry& entry) const {
        return entry.used_ms + limits_.idle.count();
    }

private:
    void reserve(const std::string& owner, const std::string& id);
    void remove(const std::string& id);
    void look_after_idle();

    const SessionLimits limits_;
    const std::filesystem::path work_;
    std::mutex mutex_;
    std::condition_variable stopping_;
    std::map<std::string, SessionEntry> entries_;  ///< by id; without `live` while it opens
    bool is_stopped_ = false;
    std::thread thread_;
};

}  // namespace lastflat::server
