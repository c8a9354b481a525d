#include "server/http/client_address.h"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <optional>

namespace lastflat::http {
namespace {

/// An IPv4 address is the same as the IPv6 address that maps it.
std::optional<std::array<unsigned char, 16>> bytes_of(const std::string& text) {
    std::array<unsigned char, 16> bytes{};
    if (::inet_pton(AF_INET, text.c_str(), bytes.data() + 12) == 1) {
        bytes[10] = bytes[11] = 0xff;
        return bytes;
    }
    if (::inet_pton(AF_INET6, text.c_str(), bytes.data()) == 1) return bytes;
    return std::nullopt;
}

/// The last item of a list, which loses it.
std::string last_item(std::string_view& list) {
    const std::size_t comma = list.rfind(',');
    std::string_view item = comma == std::string_view::npos ? list : list.substr(comma + 1);
    list = list.substr(0, comma == std::string_view::npos ? 0 : comma);
    while (!item.empty() && item.front() == ' ') item.remove_prefix(1);
    while (!item.empty() && item.back() == ' ') item.remove_suffix(1);
    return std::string(item);
}

}  // namespace

bool is_address(const std::string& text) {
    return bytes_of(text).has_value();
}

std::string client_address(const std::string& peer, std::string_view forwarded_for,
                           const std::vector<std::string>& trusted_proxies) {
    const auto is_trusted = [&](const std::string& address) {
        return std::any_of(trusted_proxies.begin(), trusted_proxies.end(),
                           [&](const auto& proxy) { return bytes_of(proxy) == bytes_of(address); });
    };
    std::string client = peer;
    while (is_trusted(client) && !forwarded_for.empty()) {
        std::string before = last_item(forwarded_for);
        if (!is_address(before)) break;
        client = std::move(before);
    }
    return client;
}

std::string network_of(const std::string& address) {
    in6_addr bytes{};
    if (::inet_pton(AF_INET6, address.c_str(), &bytes) != 1) return address;
    if (IN6_IS_ADDR_V4MAPPED(&bytes)) return address;
    std::fill(bytes.s6_addr + 8, bytes.s6_addr + 16, std::uint8_t{0});
    std::array<char, INET6_ADDRSTRLEN> text{};
    ::inet_ntop(AF_INET6, &bytes, text.data(), text.size());
    return std::string(text.data()) + "/64";
}

}  // namespace lastflat::http
