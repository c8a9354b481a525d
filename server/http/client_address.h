// Where a request comes from.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lastflat::http {

/// An IPv4 or IPv6 address in digits.
[[nodiscard]] bool is_address(const std::string& text);

/// The address that a request comes from. Behind proxies that are trusted it is the last one of
/// `X-Forwarded-For` that is none of theirs; what stands before it anybody may have written.
///
/// In:  the peer's address; the header, empty if it is absent; the addresses of the proxies.
[[nodiscard]] std::string client_address(const std::string& peer, std::string_view forwarded_for,
                                         const std::vector<std::string>& trusted_proxies);

/// What one client has to itself: an IPv4 address, the first 64 bits of an IPv6 address.
[[nodiscard]] std::string network_of(const std::string& address);

}  // namespace lastflat::http
