#include "server/routes/webhook_routes.h"

#include <nlohmann/json.hpp>

#include "api/base64.h"
#include "api/job.h"
#include "api/object_reader.h"
#include "api/webhook_request.h"
#include "server/jobs/job_intake.h"
#include "server/routes/answers.h"
#include "server/support/clock.h"
#include "server/support/crypto.h"
#include "server/webhooks/post_message.h"

namespace lastflat::server {
namespace {

using http::Request;
using http::Response;
using Json = nlohmann::ordered_json;

constexpr std::size_t most_webhooks = 16, secret_bytes = 24;
constexpr int deepest_webhook = 4;

Json webhook_json(const Webhook& webhook) {
    Json events = Json::array();
    std::size_t begin = 0;
    while (begin < webhook.events.size()) {
        const std::size_t end = std::min(webhook.events.find(' ', begin), webhook.events.size());
        events.push_back(webhook.events.substr(begin, end - begin));
        begin = end + 1;
    }
    return {{"id", webhook.id},
            {"url", webhook.url},
            {"events", std::move(events)},
            {"created_at", api::rfc3339(webhook.created_ms)}};
}

Json delivery_json(const Delivery& delivery) {
    Json json{{"id", delivery.id},
              {"event", delivery.event},
              {"created_at", api::rfc3339(delivery.created_ms)},
              {"attempt", delivery.attempt},
              {"delivered", delivery.delivered}};
    if (delivery.status != 0) json["status"] = delivery.status;
    if (!delivery.error.empty()) json["error"] = delivery.error;
    if (delivery.next_ms) json["next_attempt_at"] = api::rfc3339(*delivery.next_ms);
    json["payload"] = Json::parse(delivery.payload);
    return json;
}

Webhook read_webhook(const Request& request) {
    if (request.body.empty() || request.body.front().media_type != "application/json")
        refuse(415, "media_type_unsupported", "a webhook is sent as application/json");
    const auto document = api::parse_json(request.body.front().bytes, deepest_webhook);
    const auto asked = api::read_webhook(api::Field{document, ""}, api::WebhookScope::jobs);
    if (!is_webhook_url(asked.url)) throw api::InvalidRequest("/url", not_a_webhook_url);
    Webhook webhook;
    webhook.url = asked.url;
    webhook.events = asked.events;
    return webhook;
}

Webhook found(WebhookStore& webhooks, const Request& request) {
    const auto webhook = webhooks.find(request.principal, request.captures.at(0));
    if (!webhook) refuse(404, "webhook_not_found", "there is no webhook of this id");
    return *webhook;
}

Response add_webhook(WebhookStore& webhooks, bool sends, const Request& request) {
    require_webhooks(sends);
    Webhook webhook = read_webhook(request);
    if (webhooks.list(request.principal).size() >= most_webhooks)
        refuse(422, "too_many_webhooks",
               "there are " + std::to_string(most_webhooks) + " webhooks already; delete one");
    webhook.id = new_job_id();
    webhook.owner = request.principal;
    webhook.secret =
        std::string(api::secret_prefix) + api::encode_base64(random_bytes(secret_bytes));
    webhook.created_ms = now_ms();
    webhooks.add(webhook);
    Json json = webhook_json(webhook);
    json["secret"] = webhook.secret;  // this once
    Response response = json_response(201, json.dump());
    response.headers.emplace_back("Location", "/v1/webhooks/" + webhook.id);
    return response;
}

Response list_webhooks(WebhookStore& webhooks, const Request& request) {
    Json items = Json::array();
    for (const Webhook& webhook : webhooks.list(request.principal))
        items.push_back(webhook_json(webhook));
    return json_response(200, Json{{"items", std::move(items)}}.dump());
}

Response deliveries(WebhookStore& webhooks, const Request& request) {
    Json items = Json::array();
    for (const Delivery& delivery : webhooks.deliveries(found(webhooks, request).id))
        items.push_back(delivery_json(delivery));
    return json_response(200, Json{{"items", std::move(items)}}.dump());
}

Response test_webhook(WebhookStore& webhooks, bool sends, const Request& request) {
    require_webhooks(sends);
    const Webhook webhook = found(webhooks, request);
    if (!webhooks.add_test(webhook.id))
        refuse(429, "too_many_messages", "messages to this webhook are waiting already; see them");
    return json_response(202, webhook_json(webhook).dump());
}

Response remove_webhook(WebhookStore& webhooks, const Request& request) {
    if (!webhooks.remove(request.principal, request.captures.at(0)))
        refuse(404, "webhook_not_found", "there is no webhook of this id");
    return empty_response(204);
}

}  // namespace

std::vector<http::Route> webhook_routes(WebhookStore& webhooks, bool sends) {
    return {{"POST", "/v1/webhooks", guarded([&webhooks, sends](const Request& r) {
                 return add_webhook(webhooks, sends, r);
             }),
             true},
            {"GET", "/v1/webhooks",
             guarded([&webhooks](const Request& r) { return list_webhooks(webhooks, r); })},
            {"GET", "/v1/webhooks/{id}", guarded([&webhooks](const Request& r) {
                 return json_response(200, webhook_json(found(webhooks, r)).dump());
             })},
            {"DELETE", "/v1/webhooks/{id}",
             guarded([&webhooks](const Request& r) { return remove_webhook(webhooks, r); })},
            {"POST", "/v1/webhooks/{id}/test", guarded([&webhooks, sends](const Request& r) {
                 return test_webhook(webhooks, sends, r);
             })},
            {"GET", "/v1/webhooks/{id}/deliveries",
             guarded([&webhooks](const Request& r) { return deliveries(webhooks, r); })}};
}

}  // namespace lastflat::server
