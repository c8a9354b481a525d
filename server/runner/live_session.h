// A worker that stays, as the service sees it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "server/protocol/session_messages.h"
#include "server/runner/child_process.h"
#include "server/runner/worker_process.h"

namespace lastflat::server {

/// One process, asked from any thread. Whatever it does, whoever asks is answered.
class LiveSession {
public:
    /// Starts it; `limits.time` is that of every answer. Throws: std::system_error.
    LiveSession(WorkOrder order, const ProcessLimits& limits);
    /// Ends it.
    ~LiveSession();

    /// What it opened with. Throws as `ask`.
    [[nodiscard]] std::string opened();
    /// The body of the answer. Throws: api::Refusal: the problem that is the answer; 410 once the
    /// process has ended; 429 if too many wait.
    [[nodiscard]] std::string ask(SessionAsk ask);

    [[nodiscard]] bool is_over() const;
    /// How many wait for an answer.
    [[nodiscard]] std::size_t waiting() const;
    /// Ends the process; whoever waits is told.
    void end(const std::string& why);

private:
    [[nodiscard]] std::string wait_for(std::uint64_t number);
    void send(std::string_view bytes);
    void follow();

    const std::chrono::milliseconds time_;
    Pipe asks_;
    ChildProcess process_;
    mutable std::mutex mutex_;
    std::mutex sending_;
    std::condition_variable changed_;
    std::map<std::uint64_t, SessionAnswer> answers_;
    std::uint64_t number_ = 0;
    std::size_t waiting_ = 0;
    bool is_over_ = false;
    std::string why_;
    std::thread thread_;
};

}  // namespace lastflat::server
