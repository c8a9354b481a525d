// Where clients want to be told, and what is still to be sent.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lastflat::server {

/// One for a single job has the job's id and is forgotten with it.
struct Webhook {
    std::string id, owner, url;
    std::string secret;  ///< "whsec_" and base64
    std::string events;  ///< names with a space between
    std::int64_t created_ms = 0;
};

struct Delivery {
    std::int64_t seq = 0;  ///< in the order of their making
    std::string id;        ///< the same for every attempt
    std::string webhook, event, payload;
    std::int64_t created_ms = 0;
    int attempt = 0;
    std::optional<std::int64_t> next_ms;  ///< of the next attempt; nothing: there is none
    bool delivered = false;
    int status = 0;  ///< of the last answer; 0: there was none
    std::string error;
};

/// A message and where it goes.
struct DueDelivery {
    Delivery delivery;
    Webhook webhook;
};

/// Every call is safe from any thread and may throw StoreError.
class WebhookStore {
public:
    virtual ~WebhookStore() = default;
    virtual void add(const Webhook& webhook) = 0;
    /// Without those for single jobs.
    [[nodiscard]] virtual std::vector<Webhook> list(const std::string& owner) = 0;
    [[nodiscard]] virtual std::optional<Webhook> find(const std::string& owner,
                                                      const std::string& id) = 0;
    /// Forgets its messages too.
    [[nodiscard]] virtual bool remove(const std::string& owner, const std::string& id) = 0;
    /// The newest messages.
    [[nodiscard]] virtual std::vector<Delivery> deliveries(const std::string& id) = 0;
    /// Puts a message of the kind "test" into the queue. False: too many wait, or it is gone.
    [[nodiscard]] virtual bool add_test(const std::string& id) = 0;
    /// The oldest message that is due; it is due again after `lease_ms` unless it is settled.
    [[nodiscard]] virtual std::optional<DueDelivery> claim(std::int64_t lease_ms) = 0;
    /// What became of an attempt. `next_ms`: when to try again.
    virtual void settle(const Delivery& delivery) = 0;
};

}  // namespace lastflat::server
