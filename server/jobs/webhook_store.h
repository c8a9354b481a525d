// Where clients want to be told, and what is still to be sent.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "api/webhook.h"

namespace lastflat::server {

/// One for a single job has the job's id and is forgotten with it.
struct Webhook : api::Webhook {
    std::string owner;
};

struct Delivery : api::Delivery {
    std::int64_t seq = 0;  ///< in the order of their making
    std::string owner, webhook;
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
    [[nodiscard]] virtual std::vector<Delivery> deliveries(const std::string& owner,
                                                           const std::string& id) = 0;
    /// Puts a message of the kind "test" into the queue. False: too many wait, or it is gone.
    [[nodiscard]] virtual bool add_test(const std::string& owner, const std::string& id) = 0;
    /// The next message that is due; it is due again after `lease_ms` unless it is settled. Owners
    /// take turns, and none has more than `most_of_owner` messages on the way. A receiver that did
    /// not answer gets one message at a time, until it answers.
    [[nodiscard]] virtual std::optional<DueDelivery> claim(std::int64_t lease_ms,
                                                           int most_of_owner) = 0;
    /// What became of an attempt. `next_ms`: when to try again. Without an answer, all messages to
    /// that receiver wait: 5 s, doubling with every attempt, up to 10 min. An answer ends that.
    virtual void settle(const Delivery& delivery) = 0;
};

}  // namespace lastflat::server
