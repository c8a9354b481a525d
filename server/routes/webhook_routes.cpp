#include "server/routes/webhook_routes.h"

#include "api/base64.h"
#include "api/object_reader.h"
#include "api/webhook.h"
#include "server/jobs/job_intake.h"
#include "server/routes/answers.h"
#include "server/support/clock.h"
#include "server/support/crypto.h"
#include "server/webhooks/post_message.h"

namespace lastflat::server {
namespace {

using http::Request;
using http::Response;

constexpr std::size_t most_webhooks = 16, secret_bytes = 24;

Webhook read_webhook(const Request& request) {
    if (request.body.empty() || request.body.front().media_type != "application/json")
        api::refuse("media_type_unsupported", "a webhook is sent as application/json");
    const auto asked = api::webhook_from_json(request.body.front().bytes);
    if (!is_webhook_url(asked.url)) throw api::InvalidRequest("/url", not_a_webhook_url);
    Webhook webhook;
    webhook.url = asked.url;
    webhook.events = asked.events;
    return webhook;
}

Webhook found(WebhookStore& webhooks, const Request& request) {
    const auto webhook = webhooks.find(request.principal, request.captures.at(0));
    if (!webhook) api::refuse("webhook_not_found", "there is no webhook of this id");
    return *webhook;
}

Response add_webhook(WebhookStore& webhooks, bool sends, const Request& request) {
    require_webhooks(sends);
    Webhook webhook = read_webhook(request);
    if (webhooks.list(request.principal).size() >= most_webhooks)
        api::refuse("too_many_webhooks",
                    "there are " + std::to_string(most_webhooks) + " webhooks already; delete one");
    webhook.id = new_job_id();
    webhook.owner = request.principal;
    webhook.secret =
        std::string(api::secret_prefix) + api::encode_base64(random_bytes(secret_bytes));
    webhook.created_ms = now_ms();
    webhooks.add(webhook);
    Response response = json_response(201, to_json(webhook, true));
    response.headers.emplace_back("Location", "/v1/webhooks/" + webhook.id);
    return response;
}

Response list_webhooks(WebhookStore& webhooks, const Request& request) {
    const auto found = webhooks.list(request.principal);
    return json_response(200, api::to_json(std::vector<api::Webhook>(found.begin(), found.end())));
}

Response deliveries(WebhookStore& webhooks, const Request& request) {
    const auto sent = webhooks.deliveries(request.principal, found(webhooks, request).id);
    return json_response(200, api::to_json(std::vector<api::Delivery>(sent.begin(), sent.end())));
}

Response test_webhook(WebhookStore& webhooks, bool sends, const Request& request) {
    require_webhooks(sends);
    const Webhook webhook = found(webhooks, request);
    if (!webhooks.add_test(request.principal, webhook.id))
        api::refuse("too_many_messages", "messages to this webhook are waiting already; see them");
    return json_response(202, to_json(webhook, false));
}

Response remove_webhook(WebhookStore& webhooks, const Request& request) {
    if (!webhooks.remove(request.principal, request.captures.at(0)))
        api::refuse("webhook_not_found", "there is no webhook of this id");
    return empty_response(204);
}

}  // namespace

std::vector<http::Route> webhook_routes(WebhookStore& webhooks, bool sends) {
    return {
        {"POST", "/v1/webhooks",
         [&webhooks, sends](const Request& r) { return add_webhook(webhooks, sends, r); }, true},
        {"GET", "/v1/webhooks",
         [&webhooks](const Request& r) { return list_webhooks(webhooks, r); }},
        {"GET", "/v1/webhooks/{id}",
         [&webhooks](const Request& r) {
             return json_response(200, to_json(found(webhooks, r), false));
         }},
        {"DELETE", "/v1/webhooks/{id}",
         [&webhooks](const Request& r) { return remove_webhook(webhooks, r); }},
        {"POST", "/v1/webhooks/{id}/test",
         [&webhooks, sends](const Request& r) { return test_webhook(webhooks, sends, r); }},
        {"GET", "/v1/webhooks/{id}/deliveries",
         [&webhooks](const Request& r) { return deliveries(webhooks, r); }}};
}

}  // namespace lastflat::server
