// Any bytes as the head of a request, in one piece and byte by byte.
#include "core/utf8.h"
#include "server/http/head.h"
#include "server/http/text.h"
#include "tests/fuzz/mesh_checks.h"

namespace {

using namespace lastflat;
using namespace lastflat::http;

Response nothing(const http::Request&) {
    return {};
}

const RouteTable& routes() {
    static const RouteTable table({{"GET", "/healthz", nothing, false, true},
                                   {"POST", "/v1/jobs", nothing, true},
                                   {"GET", "/v1/jobs/{id}", nothing},
                                   {"DELETE", "/v1/jobs/{id}", nothing},
                                   {"GET", "/v1/jobs/{id}/result", nothing},
                                   {"POST", "/v1/jobs/{id}/cancel", nothing}});
    return table;
}

/// The head must end at the same byte, however the bytes arrive.
std::optional<std::size_t> length_byte_by_byte(std::string_view bytes) {
    for (std::size_t n = 1; n <= bytes.size(); ++n) {
        if (const auto length = head_length(bytes.substr(0, n), n > 3 ? n - 3 : 0)) return length;
    }
    return std::nullopt;
}

void check(const Head& head) {
    fuzz::require(head.route != nullptr);
    fuzz::require(!head.chunked || head.content_length == 0);
    fuzz::require(!head.has_body() || head.route->takes_body);
    fuzz::require(is_utf8(head.request.path) && !has_control_characters(head.request.path));
    for (const auto& [name, value] : head.request.query) {
        fuzz::require(is_utf8(name) && is_utf8(value) && !has_control_characters(name + value));
    }
    for (const auto& [name, value] : head.request.headers) {
        fuzz::require(is_token(name) && value.find_first_of("\r\n") == std::string::npos);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto bytes = fuzz::text(data, size);
    const auto length = head_length(bytes, 0);
    fuzz::require(!length || *length <= size);
    if (length && is_token(bytes.substr(0, 1))) fuzz::require(length == length_byte_by_byte(bytes));
    try {
        check(vet_head(bytes.substr(0, length.value_or(size)), routes(), ServerLimits()));
    } catch (const RefusedHead& refusal) {
        fuzz::require(refusal.problem().status >= 400);
    }
    return 0;
}
