// Based on: Standard Webhooks 1.0.0.
#include "server/webhooks/post_message.h"

#include <curl/curl.h>
#include <fcntl.h>
#include <sys/socket.h>

#include <memory>

#include "api/base64.h"
#include "api/webhook.h"
#include "server/support/clock.h"
#include "server/support/crypto.h"
#include "server/webhooks/private_address.h"

namespace lastflat::server {
namespace {

constexpr long connect_ms = 5'000, whole_ms = 10'000;

curl_socket_t open_public(void*, curlsocktype, curl_sockaddr* address) {
    if (is_private(address->addr)) return CURL_SOCKET_BAD;
    return ::socket(address->family, address->socktype | SOCK_CLOEXEC, address->protocol);
}

std::size_t drop(const char*, std::size_t, std::size_t, void*) {
    return 0;  // ends the transfer: the status is all we want
}

}  // namespace

std::string signature(const std::string& secret, const std::string& id, std::int64_t timestamp,
                      const std::string& payload) {
    const std::string key =
        api::decode_base64(std::string_view(secret).substr(api::secret_prefix.size())).value_or("");
    return "v1," + api::encode_base64(
                       hmac_sha256(key, id + "." + std::to_string(timestamp) + "." + payload));
}

bool is_webhook_url(const std::string& url) {
    const std::unique_ptr<CURLU, decltype(&curl_url_cleanup)> parsed(curl_url(), curl_url_cleanup);
    if (curl_url_set(parsed.get(), CURLUPART_URL, url.c_str(), 0) != CURLUE_OK) return false;
    const auto part = [&](CURLUPart which) {
        char* text = nullptr;
        if (curl_url_get(parsed.get(), which, &text, 0) != CURLUE_OK) return std::string();
        const std::unique_ptr<char, decltype(&curl_free)> owned(text, curl_free);
        return std::string(text);
    };
    const std::string scheme = part(CURLUPART_SCHEME);
    return (scheme == "http" || scheme == "https") && !part(CURLUPART_HOST).empty() &&
           part(CURLUPART_USER).empty();
}

PostOutcome post_message(const DueDelivery& due, bool anywhere) {
    const std::unique_ptr<CURL, decltype(&curl_easy_cleanup)> handle(curl_easy_init(),
                                                                     curl_easy_cleanup);
    const std::int64_t timestamp = now_ms() / 1000;
    const std::string& payload = due.delivery.payload;
    curl_slist* list = nullptr;
    for (const std::string& header :
         {std::string("Content-Type: application/json"), std::string("User-Agent: lastflat"),
          "webhook-id: " + due.delivery.id, "webhook-timestamp: " + std::to_string(timestamp),
          "webhook-signature: " +
              signature(due.webhook.secret, due.delivery.id, timestamp, payload)})
        list = curl_slist_append(list, header.c_str());
    const std::unique_ptr<curl_slist, decltype(&curl_slist_free_all)> headers(list,
                                                                              curl_slist_free_all);
    CURL* curl = handle.get();
    curl_easy_setopt(curl, CURLOPT_URL, due.webhook.url.c_str());
    curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, "http,https");
    curl_easy_setopt(curl, CURLOPT_FOLLOWLOCATION, 0L);
    curl_easy_setopt(curl, CURLOPT_PROXY, "");
    curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);
    curl_easy_setopt(curl, CURLOPT_CONNECTTIMEOUT_MS, connect_ms);
    curl_easy_setopt(curl, CURLOPT_TIMEOUT_MS, whole_ms);
    curl_easy_setopt(curl, CURLOPT_POSTFIELDSIZE, static_cast<long>(payload.size()));
    curl_easy_setopt(curl, CURLOPT_POSTFIELDS, payload.c_str());
    curl_easy_setopt(curl, CURLOPT_HTTPHEADER, headers.get());
    curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, drop);
    if (!anywhere) curl_easy_setopt(curl, CURLOPT_OPENSOCKETFUNCTION, open_public);
    const CURLcode code = curl_easy_perform(curl);
    long status = 0;
    curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &status);
    PostOutcome outcome;
    outcome.status = static_cast<int>(status);
    if (outcome.delivered()) return outcome;
    if (status >= 300 && status < 400)
        outcome.error = "it redirects, which is not followed: register the final address";
    else if (status != 0)
        outcome.error = "it answered " + std::to_string(status);
    else if (code == CURLE_COULDNT_CONNECT && !anywhere)
        outcome.error = "no connection, or its address is not public";
    else
        outcome.error = curl_easy_strerror(code);
    return outcome;
}

}  // namespace lastflat::server
