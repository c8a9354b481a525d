// Any bytes as a PLY file: read, or refused by an Error.
#include "core/load/read_ply.h"
#include "tests/fuzz/mesh_checks.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lastflat;
    try {
        fuzz::check(read_ply(fuzz::text(data, size), fuzz::small_limits()));
    } catch (const Error&) {
    }
    return 0;
}
