// What streams of events have in common (WHATWG HTML, 9.2).
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace lastflat::server {

/// How long a stream is silent at most.
inline constexpr std::chrono::seconds heartbeat{15};

/// `data`: one line. `id`: what a client that comes back names; empty: none.
[[nodiscard]] inline std::string event(std::string_view name, const std::string& data,
                                       const std::string& id = {}) {
    return "event: " + std::string(name) + (id.empty() ? "" : "\nid: " + id) + "\ndata: " + data +
           "\n\n";
}

}  // namespace lastflat::server
