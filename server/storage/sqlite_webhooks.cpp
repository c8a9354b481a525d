#include "server/storage/sqlite_webhooks.h"

#include "server/storage/sqlite_rows.h"
#include "server/support/clock.h"

namespace lastflat::server {
namespace {

constexpr int most_listed = 100, most_pending_tests = 10;

Webhook webhook_of(const Query& query) {
    return {{query.text(0), query.text(2), query.text(3), api::named_events(query.text(4)),
             query.number(5)},
            query.text(1)};
}

Delivery delivery_of(const Query& query) {
    return {{query.text(1), query.text(3), query.text(4), query.number(5),
             static_cast<int>(query.number(6)), query.maybe_number(7), query.number(8) != 0,
             static_cast<int>(query.number(9)), query.text(10)},
            query.number(0),
            query.text(2)};
}

std::optional<Webhook> find_webhook(SqliteConnection& connection, const std::string& owner,
                                    const std::string& id) {
    Query query(
        connection.prepared("SELECT id, owner, url, secret, events, created_ms "
                            "FROM webhooks WHERE id = ?1 AND (owner = ?2 OR ?2 = '')"));
    if (!query.bind(id, owner).next()) return std::nullopt;
    return webhook_of(query);
}

}  // namespace

void SqliteWebhooks::add(const Webhook& webhook) {
    database_.write([&](SqliteConnection& connection) { add_webhook(connection, webhook, ""); });
}

std::vector<Webhook> SqliteWebhooks::list(const std::string& owner) {
    return database_.read([&](SqliteConnection& connection) {
        Query query(
            connection.prepared("SELECT id, owner, url, secret, events, created_ms FROM webhooks "
                                "WHERE (owner = ?1 OR ?1 = '') AND job = '' ORDER BY id"));
        query.bind(owner);
        std::vector<Webhook> webhooks;
        while (query.next()) webhooks.push_back(webhook_of(query));
        return webhooks;
    });
}

std::optional<Webhook> SqliteWebhooks::find(const std::string& owner, const std::string& id) {
    return database_.read(
        [&](SqliteConnection& connection) { return find_webhook(connection, owner, id); });
}

bool SqliteWebhooks::remove(const std::string& owner, const std::string& id) {
    return database_.write([&](SqliteConnection& connection) {
        if (!find_webhook(connection, owner, id)) return false;
        erase_webhook(connection, id);
        return true;
    });
}

std::vector<Delivery> SqliteWebhooks::deliveries(const std::string& id) {
    return database_.read([&](SqliteConnection& connection) {
        Query query(connection.prepared(
            "SELECT seq, id, webhook, event, payload, created_ms, attempt, next_ms, delivered, "
            "status, error FROM deliveries WHERE webhook = ? ORDER BY seq DESC LIMIT ?"));
        query.bind(id, most_listed);
        std::vector<Delivery> deliveries;
        while (query.next()) deliveries.push_back(delivery_of(query));
        return deliveries;
    });
}

bool SqliteWebhooks::add_test(const std::string& id) {
    return database_.write([&](SqliteConnection& connection) {
        return add_delivery(connection, id, {now_ms(), api::WebhookTest{id}}, most_pending_tests);
    });
}

std::optional<DueDelivery> SqliteWebhooks::claim(std::int64_t lease_ms) {
    return database_.write([&](SqliteConnection& connection) -> std::optional<DueDelivery> {
        Query query(connection.prepared(
            "SELECT seq, id, webhook, event, payload, created_ms, attempt, next_ms, delivered, "
            "status, error FROM deliveries WHERE next_ms <= ? ORDER BY next_ms LIMIT 1"));
        if (!query.bind(now_ms()).next()) return std::nullopt;
        DueDelivery due{delivery_of(query), {}};
        const auto webhook = find_webhook(connection, "", due.delivery.webhook);
        if (!webhook) throw StoreError("a message has no webhook");
        due.webhook = *webhook;
        ++due.delivery.attempt;
        Query(connection.prepared("UPDATE deliveries SET next_ms = ?, attempt = ? WHERE seq = ?"))
            .bind(now_ms() + lease_ms, due.delivery.attempt, due.delivery.seq)
            .run();
        return due;
    });
}

void SqliteWebhooks::settle(const Delivery& delivery) {
    database_.write([&](SqliteConnection& connection) {
        Query(connection.prepared("UPDATE deliveries SET next_ms = ?, delivered = ?, status = ?, "
                                  "error = ? WHERE seq = ?"))
            .bind(delivery.next_ms, delivery.delivered ? 1 : 0, delivery.status, delivery.error,
                  delivery.seq)
            .run();
        // A list of what was sent, not an archive.
        Query(connection.prepared(
                  "DELETE FROM deliveries WHERE webhook = ?1 AND next_ms IS NULL AND seq <= "
                  "(SELECT seq FROM deliveries WHERE webhook = ?1 ORDER BY seq DESC LIMIT 1 "
                  "OFFSET 1000)"))
            .bind(delivery.webhook)
            .run();
    });
}

}  // namespace lastflat::server
