// Any bytes as a chunked body. The first byte says in what steps the rest arrives: where the body
// ends, and how, and what it holds, must not depend on it.
#include <string>

#include "server/http/chunked_framing.h"
#include "tests/fuzz/mesh_checks.h"

namespace {

using lastflat::http::ChunkedFraming;

struct Outcome {
    std::size_t used = 0;
    std::string data;
    bool complete, broken, too_large;
    bool operator==(const Outcome&) const = default;
};

Outcome follow(std::string_view bytes, std::size_t step) {
    ChunkedFraming framing(1000);
    lastflat::http::Buffer data;
    std::size_t used = 0;
    while (used < bytes.size()) {
        const auto piece = bytes.substr(used, step);
        const std::size_t sound = framing.follow(piece, data);
        lastflat::fuzz::require(sound <= piece.size());
        used += sound;
        if (sound < piece.size()) break;
    }
    const Outcome outcome{used, std::string(data.view()), framing.complete(), framing.broken(),
                          framing.too_large()};
    lastflat::fuzz::require(outcome.complete + outcome.broken + outcome.too_large <= 1);
    return outcome;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const auto bytes = lastflat::fuzz::text(data + 1, size - 1);
    lastflat::fuzz::require(follow(bytes, bytes.size()) == follow(bytes, 1u + data[0] % 16u));
    return 0;
}
