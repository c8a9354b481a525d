// Answers on their way out: which headers may leave, and the bytes of an answer that is sent
// without the help of the HTTP library.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "server/http/http.h"

namespace lastflat::http {

/// The headers of every answer, then those of this one. Left out: names that are not tokens, values
/// with control characters, and what frames the message (length, encoding, connection), which is
/// decided by whoever writes it.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> outgoing_headers(
    const Response& response);

/// The type of a body, never empty: without one, browsers guess.
[[nodiscard]] std::string outgoing_media_type(const Response& response);

/// The whole answer as HTTP/1.1 with "Connection: close".
[[nodiscard]] std::string answer_bytes(const Response& response, bool without_body);

}  // namespace lastflat::http
