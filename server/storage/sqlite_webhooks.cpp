#include "server/storage/sqlite_webhooks.h"

#include <algorithm>

#include "server/storage/sqlite_rows.h"
#include "server/storage/sqlite_turns.h"
#include "server/support/clock.h"

namespace lastflat::server {
namespace {

constexpr int most_shown = 100, most_pending_tests = 10;
constexpr std::int64_t first_pause_ms = 5'000, longest_pause_ms = 600'000;

Webhook webhook_of(const Query& query) {
    return {{query.text(0), query.text(2), query.text(3), api::named_events(query.text(4)),
             query.number(5)},
            query.text(1)};
}

constexpr char select_delivery[] =
    "SELECT seq, id, owner, webhook, event, payload, created_ms, attempt, next_ms, delivered, "
    "status, error FROM deliveries ";

Delivery delivery_of(const Query& query) {
    return {{query.text(1), query.text(4), query.text(5), query.number(6),
             static_cast<int>(query.number(7)), query.maybe_number(8), query.number(9) != 0,
             static_cast<int>(query.number(10)), query.text(11)},
            query.number(0),
            query.text(2),
            query.text(3)};
}

std::optional<Webhook> find_webhook(SqliteConnection& connection, const std::string& owner,
                                    const std::string& id) {
    Query query(
        connection.prepared("SELECT id, owner, url, secret, events, created_ms "
                            "FROM webhooks WHERE owner = ? AND id = ?"));
    if (!query.bind(owner, id).next()) return std::nullopt;
    return webhook_of(query);
}

/// Of all waiting messages to the receiver of this one.
constexpr char where_same_receiver[] =
    " WHERE next_ms IS NOT NULL AND (owner, receiver) = "
    "(SELECT owner, receiver FROM deliveries WHERE seq = ?1) ";

/// While a silent receiver is tried, its other messages are not.
void let_others_wait(SqliteConnection& connection, std::int64_t seq, std::int64_t until_ms) {
    Query(connection.prepared("UPDATE deliveries SET next_ms = max(next_ms, ?2)" +
                              std::string(where_same_receiver) +
                              "AND seq <> ?1 AND (owner, receiver) IN (SELECT owner, receiver FROM "
                              "silent_receivers)"))
        .bind(seq, until_ms)
        .run();
}

void note_silence(SqliteConnection& connection, std::int64_t seq) {
    Query failures(connection.prepared(
        "INSERT INTO silent_receivers SELECT owner, receiver, 1 FROM deliveries WHERE seq = ? "
        "ON CONFLICT DO UPDATE SET failures = failures + 1 RETURNING failures"));
    if (!failures.bind(seq).next()) return;  // the webhook was deleted meanwhile
    const std::int64_t pause_ms = std::min(
        first_pause_ms << std::min<std::int64_t>(failures.number(0) - 1, 20), longest_pause_ms);
    Query(connection.prepared("UPDATE deliveries SET next_ms = max(next_ms, ?2)" +
                              std::string(where_same_receiver)))
        .bind(seq, now_ms() + pause_ms)
        .run();
}

void note_answer(SqliteConnection& connection, std::int64_t seq) {
    const int silent =
        Query(connection.prepared("DELETE FROM silent_receivers WHERE (owner, receiver) = "
                                  "(SELECT owner, receiver FROM deliveries WHERE seq = ?)"))
            .bind(seq)
            .run();
    if (silent == 0) return;
    Query(connection.prepared("UPDATE deliveries SET next_ms = ?2" +
                              std::string(where_same_receiver) +
                              "AND seq <> ?1 AND lease_until_ms IS NULL"))
        .bind(seq, now_ms())
        .run();
}

}  // namespace

void SqliteWebhooks::add(const Webhook& webhook) {
    database_.write([&](SqliteConnection& connection) { add_webhook(connection, webhook, ""); });
}

std::vector<Webhook> SqliteWebhooks::list(const std::string& owner) {
    return database_.read([&](SqliteConnection& connection) {
        Query query(
            connection.prepared("SELECT id, owner, url, secret, events, created_ms FROM webhooks "
                                "WHERE owner = ? AND job = '' ORDER BY id"));
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
        erase_webhook(connection, owner, id);
        return true;
    });
}

std::vector<Delivery> SqliteWebhooks::deliveries(const std::string& owner, const std::string& id) {
    return database_.read([&](SqliteConnection& connection) {
        Query query(
            connection.prepared(std::string(select_delivery) +
                                "WHERE owner = ? AND webhook = ? ORDER BY seq DESC LIMIT ?"));
        query.bind(owner, id, most_shown);
        std::vector<Delivery> deliveries;
        while (query.next()) deliveries.push_back(delivery_of(query));
        return deliveries;
    });
}

bool SqliteWebhooks::add_test(const std::string& owner, const std::string& id) {
    return database_.write([&](SqliteConnection& connection) {
        return add_delivery(connection, owner, id, {now_ms(), api::WebhookTest{id}},
                            most_pending_tests);
    });
}

std::optional<DueDelivery> SqliteWebhooks::claim(std::int64_t lease_ms, int most_of_owner) {
    return database_.write([&](SqliteConnection& connection) -> std::optional<DueDelivery> {
        const auto owner = take_delivery_turn(connection, most_of_owner);
        if (!owner) return std::nullopt;
        Query query(
            connection.prepared(std::string(select_delivery) +
                                "WHERE owner = ? AND next_ms <= ? ORDER BY next_ms, seq LIMIT 1"));
        if (!query.bind(*owner, now_ms()).next()) return std::nullopt;
        DueDelivery due{delivery_of(query), {}};
        const auto webhook = find_webhook(connection, *owner, due.delivery.webhook);
        if (!webhook) throw StoreError("a message has no webhook");
        due.webhook = *webhook;
        ++due.delivery.attempt;
        const std::int64_t until_ms = now_ms() + lease_ms;
        Query(connection.prepared("UPDATE deliveries SET next_ms = ?1, lease_until_ms = ?1, "
                                  "attempt = ?2 WHERE seq = ?3"))
            .bind(until_ms, due.delivery.attempt, due.delivery.seq)
            .run();
        let_others_wait(connection, due.delivery.seq, until_ms);
        return due;
    });
}

void SqliteWebhooks::settle(const Delivery& delivery) {
    database_.write([&](SqliteConnection& connection) {
        Query(connection.prepared("UPDATE deliveries SET next_ms = ?, lease_until_ms = NULL, "
                                  "delivered = ?, status = ?, error = ? WHERE seq = ?"))
            .bind(delivery.next_ms, delivery.delivered ? 1 : 0, delivery.status, delivery.error,
                  delivery.seq)
            .run();
        if (delivery.status == 0)
            note_silence(connection, delivery.seq);
        else
            note_answer(connection, delivery.seq);
        // A list of what was sent, not an archive.
        Query(connection.prepared(
                  "DELETE FROM deliveries WHERE owner = ?1 AND webhook = ?2 AND next_ms IS NULL "
                  "AND seq <= (SELECT seq FROM deliveries WHERE owner = ?1 AND webhook = ?2 "
                  "ORDER BY seq DESC LIMIT 1 OFFSET 1000)"))
            .bind(delivery.owner, delivery.webhook)
            .run();
    });
}

}  // namespace lastflat::server
