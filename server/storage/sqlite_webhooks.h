// Webhooks in SQLite.
#pragma once

#include "server/jobs/webhook_store.h"
#include "server/storage/sqlite.h"

namespace lastflat::server {

class SqliteWebhooks final : public WebhookStore {
public:
    /// The database must outlive the store.
    explicit SqliteWebhooks(SqliteDatabase& database) : database_(database) {}
    void add(const Webhook& webhook) override;
    [[nodiscard]] std::vector<Webhook> list(const std::string& owner) override;
    [[nodiscard]] std::optional<Webhook> find(const std::string& owner,
                                              const std::string& id) override;
    [[nodiscard]] bool remove(const std::string& owner, const std::string& id) override;
    [[nodiscard]] std::vector<Delivery> deliveries(const std::string& owner,
                                                   const std::string& id) override;
    [[nodiscard]] bool add_test(const std::string& owner, const std::string& id) override;
    [[nodiscard]] std::optional<DueDelivery> claim(std::int64_t lease_ms,
                                                   int most_of_owner) override;
    void settle(const Delivery& delivery) override;

private:
    SqliteDatabase& database_;
};

}  // namespace lastflat::server
