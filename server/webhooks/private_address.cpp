#include "server/webhooks/private_address.h"

#include <netinet/in.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

namespace lastflat::server {
namespace {

struct Range {
    std::uint32_t network;
    int bits;
};

bool is_private_v4(std::uint32_t address) {
    constexpr std::array<Range, 13> ranges{{{0x00000000, 8},
                                            {0x0A000000, 8},
                                            {0x64400000, 10},
                                            {0x7F000000, 8},
                                            {0xA9FE0000, 16},
                                            {0xAC100000, 12},
                                            {0xC0000000, 24},
                                            {0xC0000200, 24},
                                            {0xC0A80000, 16},
                                            {0xC6120000, 15},
                                            {0xC6336400, 24},
                                            {0xCB007100, 24},
                                            {0xE0000000, 3}}};  // multicast and reserved
    return std::any_of(ranges.begin(), ranges.end(), [&](const Range& range) {
        return (address ^ range.network) >> (32 - range.bits) == 0;
    });
}

std::uint32_t v4_at(const std::uint8_t* bytes) {
    return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 |
           std::uint32_t{bytes[2]} << 8 | std::uint32_t{bytes[3]};
}

bool is_private_v6(const std::uint8_t* b) {
    const auto starts_with = [&](std::initializer_list<std::uint8_t> prefix) {
        return std::equal(prefix.begin(), prefix.end(), b);
    };
    if (starts_with({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF}))
        return is_private_v4(v4_at(b + 12));
    if (starts_with({0, 0x64, 0xFF, 0x9B})) return true;                // NAT64
    if (starts_with({0x20, 0x02})) return is_private_v4(v4_at(b + 2));  // 6to4
    if (starts_with({0x20, 0x01, 0x00, 0x00})) return true;             // Teredo
    if (starts_with({0x20, 0x01, 0x0D, 0xB8})) return true;             // documentation
    return (b[0] & 0xE0) != 0x20;                                       // only 2000::/3 is public
}

}  // namespace

bool is_private(const sockaddr& address) {
    if (address.sa_family == AF_INET) {
        sockaddr_in v4{};
        std::memcpy(&v4, &address, sizeof v4);
        return is_private_v4(ntohl(v4.sin_addr.s_addr));
    }
    if (address.sa_family == AF_INET6) {
        sockaddr_in6 v6{};
        std::memcpy(&v6, &address, sizeof v6);
        return is_private_v6(v6.sin6_addr.s6_addr);
    }
    return true;
}

}  // namespace lastflat::server
