// The first line is the Content-Type, the rest the body.
#include "server/http/multipart.h"

#include "core/utf8.h"
#include "server/http/refusal.h"
#include "server/http/text.h"
#include "tests/fuzz/mesh_checks.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lastflat;
    constexpr std::size_t most_parts = 8;
    const auto text = fuzz::text(data, size);
    const auto end = std::min(text.find('\n'), size);
    const auto body = text.substr(std::min(end + 1, size));
    try {
        const auto parts = http::parse_multipart(text.substr(0, end), body, most_parts);
        fuzz::require(parts.size() <= most_parts);
        std::size_t bytes = 0;
        for (const auto& part : parts) {
            fuzz::require(is_utf8(part.name) && !http::has_control_characters(part.name));
            fuzz::require(body.find(part.bytes) != std::string_view::npos);
            bytes += part.bytes.size();
        }
        fuzz::require(bytes <= body.size());
    } catch (const api::Refusal& refusal) {
        fuzz::require(refusal.problem().status >= 400);
    }
    return 0;
}
