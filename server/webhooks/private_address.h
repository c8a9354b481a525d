// Which addresses a webhook must not reach: those inside, which a client could not reach itself.
#pragma once

#include <sys/socket.h>

namespace lastflat::server {

/// Everything that is not an address of the public internet: loopback, private and shared ranges,
/// link-local (where clouds keep their secrets), multicast, reserved; and IPv6 that carries such an
/// IPv4 inside. Source: the IANA special-purpose registries (RFC 6890).
[[nodiscard]] bool is_private(const sockaddr& address);

}  // namespace lastflat::server
