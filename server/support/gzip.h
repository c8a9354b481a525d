// gzip (RFC 1952).
#pragma once

#include <string>
#include <string_view>

namespace lastflat::server {

/// Without a time stamp: the same bytes give the same bytes.
[[nodiscard]] std::string gzip(std::string_view bytes);

}  // namespace lastflat::server
