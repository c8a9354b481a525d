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

/// Who gets the message; nothing: its webhook was deleted.
std::optional<std::string> receiver_of(SqliteConnection& connection, const Delivery& delivery) {
    Query query(connection.prepared("SELECT receiver FROM deliveries WHERE seq = ?"));
    if (!query.bind(delivery.seq).next()) return std::nullopt;
    return query.text(0);
}

/// All waiting messages of the owner to the receiver but for one.
void move_others(SqliteConnection& connection, const std::string& next_ms, const Delivery& one,
                 const std::string& receiver, std::int64_t ms) {
    Query(connection.prepared(
              "UPDATE deliveries INDEXED BY deliveries_by_receiver SET next_ms = " + next_ms +
              " WHERE owner = ?2 AND receiver = ?3 AND next_ms IS NOT NULL "
              "AND seq <> ?4 AND lease_until_ms IS NULL"))
        .bind(ms, one.owner, receiver, one.seq)
        .run();
}

/// While a silent receiver is tried, its other messages are not.
void let_others_wait(SqliteConnection& connection, const Delivery& one, std::int64_t until_ms) {
    const auto receiver = receiver_of(connection, one);
    Query silent(
        connection.prepared("SELECT 1 FROM silent_receivers WHERE owner = ? AND receiver = ?"));
    if (!receiver || !silent.bind(one.owner, *receiver).next()) return;
    move_others(connection, "max(next_ms, ?1)", one, *receiver, until_ms);
}

void note_silence(SqliteConnection& connection, const Delivery& one) {
    const auto receiver = receiver_of(connection, one);
    if (!receiver) return;
    Query failures(connection.prepared(
        "INSERT INTO silent_receivers VALUES (?, ?, 1) "
        "ON CONFLICT DO UPDATE SET failures = failures + 1 RETURNING failures"));
    if (!failures.bind(one.owner, *receiver).next()) return;
    const std::int64_t pause_ms = std::min(
        first_pause_ms << std::min<std::int64_t>(failures.number(0) - 1, 20), longest_pause_ms);
    const std::int64_t until_ms = now_ms() + pause_ms;
    Query(connection.prepared("UPDATE deliveries SET next_ms = max(next_ms, ?) WHERE seq = ?"))
        .bind(until_ms, one.seq)
        .run();
    move_others(connection, "max(next_ms, ?1)", one, *receiver, until_ms);
}

void note_answer(SqliteConnection& connection, const Delivery& one) {
    const auto receiver = receiver_of(connection, one);
    if (!receiver) return;
    const int silent =
        Query(connection.prepared("DELETE FROM silent_receivers WHERE owner = ? AND receiver = ?"))
            .bind(one.owner, *receiver)
            .run();
    if (silent > 0) move_others(connection, "?1", one, *receiver, now_ms());
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
        let_others_wait(connection, due.delivery, until_ms);
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
            note_silence(connection, delivery);
        else
            note_answer(connection, delivery);
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
