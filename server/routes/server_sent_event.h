// What streams of events have in common (WHATWG HTML, 9.2).
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <string_view>

#include "api/refusal.h"
#include "server/http/http.h"

namespace lastflat::server {

/// How long a stream is silent at most.
inline constexpr std::chrono::seconds heartbeat{15};

/// `data`: one line. `id`: what a client that comes back names; empty: none.
[[nodiscard]] inline std::string event(std::string_view name, const std::string& data,
                                       const std::string& id = {}) {
    return "event: " + std::string(name) + (id.empty() ? "" : "\nid: " + id) + "\ndata: " + data +
           "\n\n";
}

/// The stream as an answer; `what`: it tells of. Throws: api::Refusal (503) if it has no seat.
template <class Stream>
[[nodiscard]] http::Response event_response(std::shared_ptr<Stream> stream,
                                            const std::string& what) {
    if (!stream->has_seat())
        api::refuse("streams_full",
                    "all event streams and long polls are taken, or this key's share of them (the "
                    "limit --streams); poll the " +
                        what);
    http::Response response;
    response.media_type = "text/event-stream";
    response.headers.emplace_back("Cache-Control", "no-store");
    response.headers.emplace_back("X-Accel-Buffering", "no");
    response.stream = [stream](const http::Write& write) { return stream->step(write); };
    return response;
}

}  // namespace lastflat::server
