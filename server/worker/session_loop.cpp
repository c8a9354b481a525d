#include "server/worker/session_loop.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <iostream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "api/flatten_request.h"
#include "api/map.h"
#include "api/problem_of.h"
#include "api/refusal.h"
#include "api/session.h"
#include "core/export/write_surface_glb.h"
#include "core/session/session.h"
#include "server/protocol/session_messages.h"
#include "server/support/version.h"
#include "server/worker/map_points.h"

namespace lastflat::server {
namespace {

[[noreturn]] void refuse_superseded() {
    api::refuse("superseded",
                "a newer change came before this one was done; nothing of it took effect");
}

void say(const SessionAnswer& answer) {
    static std::mutex one_at_a_time;
    const std::scoped_lock lock(one_at_a_time);
    std::cout << to_bytes(answer) << std::flush;
}

/// What is to be answered. One thread reads, one answers.
class Asks {
public:
    /// Until standard input ends; then the process does.
    void read() {
        while (auto ask = read_session_ask(std::cin)) add(std::move(*ask));
        std::_Exit(0);
    }

    /// The next, and what cancels it; waits for one.
    [[nodiscard]] SessionAsk next(Progress& progress) {
        std::unique_lock lock(mutex_);
        come_.wait(lock, [&] { return !waiting_.empty(); });
        auto [ask, is_stale] = std::move(waiting_.front());
        waiting_.pop_front();
        if (ask.kind == AskKind::change) {
            running_ = &progress;
            if (is_stale || ask.sequence < newest_) progress.cancel();
        }
        return std::move(ask);
    }
    void is_done() {
        const std::scoped_lock lock(mutex_);
        running_ = nullptr;
    }

    /// Calls `work` with what cancels it as soon as anything is asked.
    template <class Work>
    void while_idle(const Work& work) {
        Progress idle;
        {
            const std::scoped_lock lock(mutex_);
            if (!waiting_.empty()) return;
            idle_ = &idle;
        }
        work(idle);
        const std::scoped_lock lock(mutex_);
        idle_ = nullptr;
    }

private:
    void add(SessionAsk ask) {
        const std::scoped_lock lock(mutex_);
        const bool is_newer = ask.kind == AskKind::change && ask.sequence > newest_;
        if (is_newer) newest_ = ask.sequence;
        if (is_newer && running_ != nullptr) running_->cancel();
        if (idle_ != nullptr) idle_->cancel();
        waiting_.emplace_back(std::move(ask), !is_newer);
        come_.notify_one();
    }

    std::mutex mutex_;
    std::condition_variable come_;
    std::deque<std::pair<SessionAsk, bool>> waiting_;  ///< and whether it came too late
    Progress* running_ = nullptr;                      ///< of the change that is being computed
    Progress* idle_ = nullptr;                         ///< of what is done while nobody asks
    std::uint64_t newest_ = 0;                         ///< sequence of all changes that have come
};

class Live {
public:
    Live(const WorkOrder& order, std::string model)
        : request_(order.request),
          options_(options_of(order)),
          session_(std::move(model), options_, opening_) {}

    [[nodiscard]] std::string answer(const SessionAsk& ask, Progress& progress) {
        switch (ask.kind) {
            case AskKind::change: return change(ask, progress);
            case AskKind::state: return state(ask.points);
            case AskKind::request: return request_.empty() ? "{}" : request_;
            case AskKind::surface: return write_surface_glb(session_.surface());
            case AskKind::map:
                return api::to_json(mapped(session_.map(), api::map_request_from_json(ask.text)));
            case AskKind::compare:
                return nlohmann::json{{"difference_mm", session_.difference_from_job(progress)}}
                    .dump();
        }
        return {};
    }
    /// Until somebody asks, or memory ends: it is a convenience.
    void settle(const Progress& progress) {
        try {
            session_.settle(progress);
        } catch (const Error& error) {
            if (error.code() != ErrorCode::canceled) throw;
        } catch (const std::bad_alloc&) {
        }
    }
    [[nodiscard]] std::string state(bool points = false) const {
        api::SessionStep whole = step_;
        whole.changed = Reach::model;
        if (points) return api::session_points(session_, whole);
        return api::session_json(session_, whole, version, request_.empty() ? "{}" : request_);
    }

private:
    static FlattenOptions options_of(const WorkOrder& order) {
        FlattenOptions options;
        options.request = api::flatten_request_from_json(order.request).asked;
        options.threads = static_cast<std::size_t>(order.threads);
        return options;
    }

    [[nodiscard]] std::string change(const SessionAsk& ask, Progress& progress) {
        std::string merged = api::merged_request(request_, ask.text);
        try {
            progress.check();
            step_.changed = session_.change(api::flatten_request_from_json(merged).asked, progress);
        } catch (const Error& error) {
            if (error.code() == ErrorCode::canceled) refuse_superseded();
            throw;
        }
        request_ = std::move(merged);
        ++step_.revision;
        step_.sequence = ask.sequence;
        return ask.points ? api::session_points(session_, step_)
                          : api::session_json(session_, step_, version);
    }

    std::string request_;
    FlattenOptions options_;
    Progress opening_{};
    Session session_;
    api::SessionStep step_{1, 0, Reach::model};
};

template <class Answer>
bool answered(std::uint64_t number, const Answer& answer) {
    try {
        say({number, {}, answer()});
        return true;
    } catch (...) {
        say({number, api::problem_of(std::current_exception()), {}});
        return false;
    }
}

/// `idle`: what is done when nobody asks.
template <class Answer, class Idle>
[[noreturn]] void answer_asks(const Answer& answer, const Idle& idle) {
    Asks asks;
    std::thread([&] { asks.read(); }).detach();
    for (;;) {
        Progress progress;
        const SessionAsk ask = asks.next(progress);
        (void)answered(ask.number, [&] { return answer(ask, progress); });
        asks.is_done();
        asks.while_idle(idle);
    }
}

}  // namespace

void session_loop(const WorkOrder& order, std::string model) {
    std::optional<Live> live;
    if (!answered(0, [&] { return live.emplace(order, std::move(model)).state(); })) std::_Exit(0);
    answer_asks(
        [&](const SessionAsk& ask, Progress& progress) { return live->answer(ask, progress); },
        [&](const Progress& progress) { live->settle(progress); });
}

void map_loop(const std::string& flat_obj) {
    std::optional<PatternMap> map;
    const auto open = [&] {
        map.emplace(read_flat_obj(flat_obj));
        return std::string();
    };
    if (!answered(0, open)) std::_Exit(0);
    answer_asks(
        [&](const SessionAsk& ask, Progress& /*progress*/) {
            return api::to_json(mapped(*map, api::map_request_from_json(ask.text)));
        },
        [](const Progress& /*progress*/) {});
}

}  // namespace lastflat::server
