#include "api/webhook.h"

#include "api/base64.h"
#include "api/json.h"
#include "api/object_reader.h"
#include "api/timestamp.h"

namespace lastflat::api {
namespace {

constexpr std::size_t longest_url = 2000;
constexpr std::size_t least_secret_bytes = 24, most_secret_bytes = 64;
constexpr int deepest_webhook = 4;

std::string read_secret(const Field& field) {
    std::string secret = field.text(secret_prefix.size() + 2 * most_secret_bytes);
    const bool is_prefixed = secret.compare(0, secret_prefix.size(), secret_prefix) == 0;
    const auto key = is_prefixed
                         ? decode_base64(std::string_view(secret).substr(secret_prefix.size()))
                         : std::nullopt;
    if (!key || key->size() < least_secret_bytes || key->size() > most_secret_bytes)
        field.fail("must be \"whsec_\" and 24 to 64 random bytes in base64");
    return secret;
}

/// Throws: std::logic_error of a state that is no end.
WebhookEvent end_of(JobState state) {
    switch (state) {
        case JobState::succeeded: return WebhookEvent::job_succeeded;
        case JobState::failed: return WebhookEvent::job_failed;
        case JobState::canceled: return WebhookEvent::job_canceled;
        default: throw std::logic_error("a job has not ended");
    }
}

}  // namespace

std::string event_names(const std::vector<WebhookEvent>& events) {
    std::string names;
    for (const WebhookEvent event : events)
        names.append(names.empty() ? "" : " ").append(word_of(webhook_events, event));
    return names;
}

std::vector<WebhookEvent> named_events(std::string_view names) {
    std::vector<WebhookEvent> events;
    while (!names.empty()) {
        const std::size_t end = std::min(names.find(' '), names.size());
        if (const auto event = value_of(webhook_events, names.substr(0, end)))
            events.push_back(*event);
        names.remove_prefix(std::min(end + 1, names.size()));
    }
    return events;
}

WebhookRequest read_webhook(const Field& field, WebhookScope scope) {
    ObjectReader reader(field);
    const auto url = reader.find("url"), events = reader.find("events");
    WebhookRequest webhook;
    if (scope == WebhookScope::job) {
        const auto secret = reader.find("secret");
        if (!secret)
            throw InvalidRequest(field.pointer + "/secret",
                                 "must be given: what the messages are signed with");
        webhook.secret = read_secret(*secret);
    }
    reader.finish();
    if (!url) throw InvalidRequest(field.pointer + "/url", "must be given: where to send to");
    webhook.url = url->text(longest_url);
    if (events) {
        for (const Field& event : events->items(std::size(webhook_events)))
            webhook.events.push_back(scope == WebhookScope::job ? event.choice(job_events)
                                                                : event.choice(webhook_events));
    }
    if (webhook.events.empty()) {
        for (const auto& event : webhook_events) {
            if (scope == WebhookScope::jobs || event.value != WebhookEvent::batch_finished)
                webhook.events.push_back(event.value);
        }
    }
    return webhook;
}

WebhookRequest webhook_from_json(std::string_view text) {
    const auto document = parse_json(text, deepest_webhook);
    return read_webhook({document, ""}, WebhookScope::jobs);
}

static Json json_of(const Webhook& webhook) {
    Json events = Json::array();
    for (const WebhookEvent event : webhook.events)
        events.push_back(word_of(webhook_events, event));
    return {{"id", webhook.id},
            {"url", webhook.url},
            {"events", std::move(events)},
            {"created_at", rfc3339(webhook.created_ms)}};
}

std::string to_json(const Webhook& webhook, bool with_secret) {
    Json json = json_of(webhook);
    if (with_secret) json["secret"] = webhook.secret;
    return text_of(json);
}

std::string to_json(const std::vector<Webhook>& webhooks) {
    return list_of(webhooks);
}

static Json json_of(const JobEnded& job) {
    Json json{{"id", job.id}, {"state", word_of(job_states, job.state)}};
    if (!job.tag.empty()) json["tag"] = job.tag;
    if (!job.batch.empty()) json["batch"] = job.batch;
    return json;
}

static Json json_of(const BatchFinished& batch) {
    return {{"batch", batch.id}, {"states", counts_json(batch.states)}};
}

static Json json_of(const WebhookTest& test) {
    return {{"webhook", test.webhook}};
}

std::string type_of(const WebhookMessage& message) {
    if (std::holds_alternative<WebhookTest>(message.data)) return "test";
    const auto* job = std::get_if<JobEnded>(&message.data);
    return std::string(word_of(webhook_events,
                               job == nullptr ? WebhookEvent::batch_finished : end_of(job->state)));
}

std::string to_json(const WebhookMessage& message) {
    return text_of(
        {{"type", type_of(message)},
         {"timestamp", rfc3339(message.at_ms)},
         {"data", std::visit([](const auto& data) { return json_of(data); }, message.data)}});
}

static Json json_of(const Delivery& delivery) {
    Json json{{"id", delivery.id},
              {"event", delivery.event},
              {"created_at", rfc3339(delivery.created_ms)},
              {"attempt", delivery.attempt},
              {"delivered", delivery.delivered}};
    if (delivery.status != 0) json["status"] = delivery.status;
    if (!delivery.error.empty()) json["error"] = delivery.error;
    if (delivery.next_ms) json["next_attempt_at"] = rfc3339(*delivery.next_ms);
    json["payload"] = Json::parse(delivery.payload);
    return json;
}

std::string to_json(const std::vector<Delivery>& deliveries) {
    return list_of(deliveries);
}

}  // namespace lastflat::api
