#include "server/runner/live_session.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>

#include "api/refusal.h"
#include "server/support/log.h"
#include "server/support/scope_exit.h"

namespace lastflat::server {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t most_waiting = 16;
constexpr int look_again_ms = 1000;

WorkOrder limited(WorkOrder order, const ProcessLimits& limits) {
    order.memory_mb = limits.memory_mb;
    order.parent = ::getpid();
    return order;
}

}  // namespace

LiveSession::LiveSession(WorkOrder order, const ProcessLimits& limits)
    : time_(limits.time), process_(limits.program, asks_.from) {
    asks_.from.close();
    ::fcntl(asks_.to.fd(), F_SETFL, O_NONBLOCK);
    thread_ = std::thread([this] { follow(); });
    send(to_line(limited(std::move(order), limits)));
}

LiveSession::~LiveSession() {
    end("it was closed");
    thread_.join();
}

std::string LiveSession::opened() {
    return wait_for(0);
}

std::string LiveSession::ask(SessionAsk ask) {
    {
        const std::scoped_lock lock(mutex_);
        if (waiting_ >= most_waiting)
            api::refuse("client_busy", "too many requests wait for this session; send fewer");
        ++waiting_;
    }
    const ScopeExit leave([&] {
        const std::scoped_lock lock(mutex_);
        --waiting_;
    });
    {
        const std::scoped_lock in_order(sending_);
        ask.number = ++number_;
        send(to_bytes(ask));
    }
    return wait_for(ask.number);
}

bool LiveSession::is_over() const {
    const std::scoped_lock lock(mutex_);
    return is_over_;
}

std::size_t LiveSession::waiting() const {
    const std::scoped_lock lock(mutex_);
    return waiting_;
}

void LiveSession::end(const std::string& why) {
    const std::scoped_lock lock(mutex_);
    if (is_over_) return;
    is_over_ = true;
    why_ = why;
    process_.kill();  // with the lock: nobody has waited for it yet
    changed_.notify_all();
}

std::string LiveSession::wait_for(std::uint64_t number) {
    std::unique_lock lock(mutex_);
    const bool in_time =
        changed_.wait_for(lock, time_, [&] { return is_over_ || answers_.contains(number); });
    if (!in_time) {
        lock.unlock();
        end("an answer took too long");
        lock.lock();
    }
    const auto found = answers_.find(number);
    if (found == answers_.end())
        api::refuse("session_lost", "the session is over: " + why_ + "; open another");
    SessionAnswer answer = std::move(found->second);
    answers_.erase(found);
    if (answer.problem) throw api::Refusal(*answer.problem);
    return std::move(answer.body);
}

/// A pipe holds 64 KiB; its reader does nothing but read.
void LiveSession::send(std::string_view bytes) {
    const auto deadline = Clock::now() + time_;
    while (!bytes.empty()) {
        const ssize_t written = ::write(asks_.to.fd(), bytes.data(), bytes.size());
        if (written > 0) bytes.remove_prefix(static_cast<std::size_t>(written));
        if (written >= 0 || errno == EINTR) continue;
        if (errno != EAGAIN || Clock::now() > deadline || is_over())
            return end("its process does not listen any more");
        pollfd writable{asks_.to.fd(), POLLOUT, 0};
        ::poll(&writable, 1, look_again_ms);
    }
}

void LiveSession::follow() {
    std::string why = "its process ended";
    try {
        while (process_.read(look_again_ms)) {
            while (auto answer = take_session_answer(process_.output)) {
                const std::scoped_lock lock(mutex_);
                answers_.insert_or_assign(answer->number, std::move(*answer));
                changed_.notify_all();
            }
        }
    } catch (const std::exception&) {
        why = "its process said nonsense";
    }
    end(why);
    const std::string reason = reason_of(process_.wait(), process_.errors);
    log_event("session_over", {{"why", why_}, {"end", reason}});
}

}  // namespace lastflat::server
