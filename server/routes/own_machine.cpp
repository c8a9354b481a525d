#include "server/routes/own_machine.h"

#include <algorithm>

#include "api/refusal.h"
#include "server/http/text.h"

namespace lastflat::server {
namespace {

/// What a proxy says of whom it speaks for.
bool is_forwarding(std::string_view header) {
    constexpr std::string_view names[]{"forwarded",
                                       "via",
                                       "x-real-ip",
                                       "cf-connecting-ip",
                                       "cf-connecting-ipv6",
                                       "true-client-ip",
                                       "fastly-client-ip",
                                       "x-client-ip",
                                       "x-cluster-client-ip",
                                       "x-original-host",
                                       "x-envoy-external-address"};
    return header.starts_with("x-forwarded") ||
           std::find(std::begin(names), std::end(names), header) != std::end(names);
}

/// "LocalHost:8080" is "localhost", "[::1]:8080" is "::1".
std::string name_of(std::string_view host) {
    const bool is_ipv6 = host.starts_with('[');
    const std::string_view name = host.substr(0, host.find(is_ipv6 ? ']' : ':'));
    return http::lower_case(is_ipv6 ? name.substr(1) : name);
}

bool is_ipv4(std::string_view name) {
    return name.find_first_not_of("0123456789.") == std::string_view::npos;
}

}  // namespace

bool is_loopback(const std::string& address) {
    return (address.starts_with("127.") && is_ipv4(address)) || address == "::1" ||
           (address.starts_with("::ffff:127.") && is_ipv4(address.substr(7))) ||
           address == "localhost" || address.ends_with(".localhost");
}

void check_client(const http::Request& request) {
    const bool forwarded =
        std::any_of(request.headers.begin(), request.headers.end(),
                    [](const auto& header) { return is_forwarding(header.first); });
    // A proxy on this machine says whom it speaks for; that is not this machine.
    if (is_loopback(request.remote_address) && !forwarded) return;
    api::refuse("no_keys",
                "this service has no API key yet and answers clients on its own machine only; "
                "its operator makes one with: lastflat keys add NAME");
}

void check_page(const http::Request& request, const std::string& listen_host,
                const std::vector<std::string>& allowed_origins) {
    const std::string host(request.header("host"));
    if (!host.empty()) {
        const std::string name = name_of(host);
        if (!is_loopback(name) && name != listen_host)
            api::refuse("host_refused",
                        "this service has no API key and is asked as localhost or 127.0.0.1, not "
                        "under another name");
    }
    const std::string origin(request.header("origin"));
    const bool is_own = origin == "http://" + host || origin == "https://" + host;
    const bool is_allowed =
        std::find(allowed_origins.begin(), allowed_origins.end(), origin) != allowed_origins.end();
    if (is_own || is_allowed) return;
    if (!origin.empty() || request.header("sec-fetch-site") == "cross-site")
        api::refuse("origin_refused",
                    "a web page of another origin may not call this service while it has no API "
                    "key; its operator allows pages with --allow-origin");
}

}  // namespace lastflat::server
