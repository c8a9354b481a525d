// The head of a request, from raw bytes: everything is refused that could be read in two ways.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "server/http/http.h"
#include "server/http/refusal.h"
#include "server/http/route_table.h"

namespace lastflat::http {

/// The longest request target, in bytes.
inline constexpr std::size_t longest_target = 8000;

struct Head {
    Request request;               ///< remote address and body are still missing
    const Route* route = nullptr;  ///< of the table the head was vetted against
    bool chunked = false;
    std::uint64_t content_length = 0;
    bool keeps_alive = false;      ///< the client may send another request afterwards
    bool takes_chunks = false;     ///< HTTP/1.1: the answer's length may be left open
    bool awaits_continue = false;  ///< the client sends the body after a "100 Continue"

    [[nodiscard]] bool has_body() const { return chunked || content_length > 0; }
};

/// The length of the head at the start of `bytes`, its empty line included. Nothing: more bytes
/// are needed. Ends early at a byte that no head can have, so that nobody waits for the rest.
/// `searched`: how many bytes an earlier call has already seen.
[[nodiscard]] std::optional<std::size_t> head_length(std::string_view bytes, std::size_t searched);

/// Reads a head and finds its route.
///
/// In:     the bytes up to and with the empty line, as `head_length` cut them.
/// Out:    a head that has one meaning only: one host, one length or `chunked`, a known route.
/// Throws: RefusedHead.
[[nodiscard]] Head vet_head(std::string_view raw, const RouteTable& routes,
                            const ServerLimits& limits);

/// The head that the HTTP library reads instead of the client's: what was vetted of the request
/// line, and no field but the one that it may act on. A path that has a route needs no encoding.
[[nodiscard]] std::string canonical_head(const Head& head);

/// Whether the bytes begin a HEAD request: its answer has no body, whatever is wrong with it.
[[nodiscard]] inline bool asks_for_head_only(std::string_view raw) {
    return raw.substr(0, 5) == "HEAD ";
}

}  // namespace lastflat::http
