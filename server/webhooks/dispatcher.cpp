#include "server/webhooks/dispatcher.h"

#include <array>

#include "server/support/clock.h"
#include "server/support/log.h"

namespace lastflat::server {
namespace {

constexpr std::chrono::milliseconds look{500};
/// A receiver that lets us wait keeps one of them, and an owner's receivers together half.
constexpr int most_at_once = 8, most_of_owner = 4;
constexpr std::int64_t lease_ms = 60'000;
constexpr int gone = 410;  ///< the receiver wants no more

}  // namespace

std::optional<std::int64_t> back_off_ms(int attempt) {
    constexpr std::array<std::int64_t, 8> seconds{5, 30, 120, 600, 1800, 7200, 18'000, 36'000};
    if (attempt < 1 || static_cast<std::size_t>(attempt) > seconds.size()) return std::nullopt;
    return 1000 * seconds[static_cast<std::size_t>(attempt - 1)];
}

WebhookDispatcher::WebhookDispatcher(WebhookStore& store, Post post)
    : store_(store), post_(std::move(post)) {
    for (int i = 0; i < most_at_once; ++i) threads_.emplace_back([this] { work(); });
}

void WebhookDispatcher::work() {
    std::unique_lock lock(mutex_);
    while (!ending_) {
        lock.unlock();
        const bool sent = send_one();
        lock.lock();
        if (!sent) ended_.wait_for(lock, look, [this] { return ending_; });
    }
}

WebhookDispatcher::~WebhookDispatcher() {
    {
        const std::scoped_lock lock(mutex_);
        ending_ = true;
    }
    ended_.notify_all();
    for (std::thread& thread : threads_) thread.join();
}

bool WebhookDispatcher::send_one() {
    try {
        auto due = store_.claim(lease_ms, most_of_owner);
        if (!due) return false;
        Delivery& delivery = due->delivery;
        const PostOutcome outcome = post_(*due);
        delivery.status = outcome.status;
        delivery.error = outcome.error;
        delivery.delivered = outcome.delivered();
        delivery.next_ms.reset();
        const auto wait = back_off_ms(delivery.attempt);
        if (!delivery.delivered && outcome.status != gone && wait)
            delivery.next_ms = now_ms() + *wait;
        store_.settle(delivery);
        log_event("webhook", {{"webhook", due->webhook.id},
                              {"message", delivery.id},
                              {"attempt", delivery.attempt},
                              {"status", delivery.status},
                              {"why", delivery.error}});
        return true;
    } catch (const std::exception& error) {
        log_event("store_failed", {{"why", error.what()}});
        return false;
    }
}

}  // namespace lastflat::server
