#include "api/webhook_request.h"

#include "api/base64.h"
#include "api/object_reader.h"

namespace lastflat::api {
namespace {

constexpr std::size_t longest_url = 2000;
constexpr std::size_t least_secret_bytes = 24, most_secret_bytes = 64;
const std::vector<std::string> event_names{"job.succeeded", "job.failed", "job.canceled"};

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

}  // namespace

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
        for (const Field& event : events->items(event_names.size()))
            webhook.events +=
                (webhook.events.empty() ? "" : " ") + event_names[event.choice(event_names)];
    }
    if (webhook.events.empty()) webhook.events = "job.succeeded job.failed job.canceled";
    return webhook;
}

}  // namespace lastflat::api
