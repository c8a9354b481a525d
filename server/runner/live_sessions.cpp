#include "server/runner/live_sessions.h"

#include <unistd.h>

#include <algorithm>

#include "api/refusal.h"
#include "server/jobs/job.h"
#include "server/runner/in_worker.h"
#include "server/support/clock.h"
#include "server/support/crypto.h"
#include "server/support/files.h"

namespace lastflat::server {

LiveSessions::LiveSessions(const SessionLimits& limits, std::filesystem::path work)
    : limits_(limits), work_(std::move(work)), thread_([this] { look_after_idle(); }) {}

LiveSessions::~LiveSessions() {
    stop();
    thread_.join();
}

void LiveSessions::reserve(const std::string& owner, const std::string& id) {
    const std::scoped_lock lock(mutex_);
    if (is_stopped_) api::refuse("draining", "the service is ending; try again later");
    std::size_t alive = 0, own = 0;
    for (const auto& [other, entry] : entries_) {
        if (entry.live && entry.live->is_over()) continue;
        ++alive;
        own += entry.owner == owner ? 1 : 0;
    }
    if (alive >= limits_.all)
        throw api::Refusal("sessions_full", "all " + std::to_string(limits_.all) +
                                                " live sessions are taken; try again later")
            .with_header("Retry-After", "30");
    if (!owner.empty() && own >= limits_.per_owner)
        throw api::Refusal("key_sessions_full", "this API key has " +
                                                    std::to_string(limits_.per_owner) +
                                                    " live sessions, as many as it may; close one")
            .with_header("Retry-After", "30");
    entries_[id] = {id, owner, work_ / ("session-" + id), now_ms(), now_ms()};
}

void LiveSessions::remove(const std::string& id) {
    std::shared_ptr<LiveSession> last;  // it ends when the lock is free again
    const std::scoped_lock lock(mutex_);
    const auto found = entries_.find(id);
    if (found == entries_.end()) return;
    last = std::move(found->second.live);
    ::unlink(found->second.model.c_str());
    if (last) last->end("it was closed");
    entries_.erase(found);
}

std::pair<SessionEntry, std::string> LiveSessions::open(const std::string& owner, Task task,
                                                        std::string_view model,
                                                        const std::string& request) {
    const std::string id = new_job_id();
    reserve(owner, id);
    try {
        WorkOrder order;
        order.task = task;
        order.model = work_ / ("session-" + id);
        order.digest = sha256(model);
        order.request = request;
        order.threads = hardware_threads();
        write_durably(order.model, model);
        const auto live = std::make_shared<LiveSession>(std::move(order), limits_.process);
        {
            const std::scoped_lock lock(mutex_);
            entries_.at(id).live = live;
        }
        std::string state = live->opened();
        return {find(owner, id), std::move(state)};
    } catch (...) {
        remove(id);
        throw;
    }
}

SessionEntry LiveSessions::find(const std::string& owner, const std::string& id) {
    const std::scoped_lock lock(mutex_);
    const auto found = entries_.find(id);
    if (found == entries_.end() || found->second.owner != owner || !found->second.live)
        api::refuse("session_not_found",
                    "there is no live session " + id + "; one that nobody asks ends after " +
                        std::to_string(limits_.idle / std::chrono::seconds(1)) + " s");
    found->second.used_ms = now_ms();
    return found->second;
}

std::vector<SessionEntry> LiveSessions::list(const std::string& owner) {
    const std::scoped_lock lock(mutex_);
    std::vector<SessionEntry> own;
    for (const auto& [id, entry] : entries_) {
        if (entry.owner == owner && entry.live) own.push_back(entry);
    }
    return own;
}

void LiveSessions::close(const std::string& owner, const std::string& id) {
    (void)find(owner, id);
    remove(id);
}

void LiveSessions::close_least_used() {
    std::string id;
    {
        const std::scoped_lock lock(mutex_);
        if (entries_.size() < limits_.all) return;
        const auto least = std::min_element(
            entries_.begin(), entries_.end(),
            [](const auto& a, const auto& b) { return a.second.used_ms < b.second.used_ms; });
        id = least->first;
    }
    remove(id);
}

void LiveSessions::stop() {
    std::vector<std::string> ids;
    {
        const std::scoped_lock lock(mutex_);
        is_stopped_ = true;
        for (const auto& [id, entry] : entries_) ids.push_back(id);
    }
    stopping_.notify_all();
    for (const std::string& id : ids) remove(id);
}

void LiveSessions::look_after_idle() {
    constexpr std::chrono::seconds pause{1};
    std::unique_lock lock(mutex_);
    while (!stopping_.wait_for(lock, pause, [&] { return is_stopped_; })) {
        std::vector<std::string> idle;
        for (const auto& [id, entry] : entries_) {
            if (entry.live && entry.live->waiting() == 0 && expires_ms(entry) < now_ms())
                idle.push_back(id);
        }
        lock.unlock();
        for (const std::string& id : idle) remove(id);
        lock.lock();
    }
}

}  // namespace lastflat::server
