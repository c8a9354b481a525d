// The threads that send what is to be sent.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "server/webhooks/post_message.h"

namespace lastflat::server {

using Post = std::function<PostOutcome(const DueDelivery&)>;

/// After how many milliseconds the attempt after this one follows; nothing: it was the last.
[[nodiscard]] std::optional<std::int64_t> back_off_ms(int attempt);

class WebhookDispatcher {
public:
    /// `store` must outlive it.
    WebhookDispatcher(WebhookStore& store, Post post);
    ~WebhookDispatcher();
    WebhookDispatcher(const WebhookDispatcher&) = delete;
    WebhookDispatcher& operator=(const WebhookDispatcher&) = delete;

private:
    void work();
    /// False: nothing was due.
    bool send_one();

    WebhookStore& store_;
    const Post post_;
    std::mutex mutex_;
    std::condition_variable ended_;
    bool ending_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace lastflat::server
