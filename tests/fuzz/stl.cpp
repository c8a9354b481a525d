// Any bytes as an STL file: read, or refused by an Error.
#include "core/load/read_stl.h"
#include "tests/fuzz/mesh_checks.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lastflat;
    try {
        fuzz::check(read_stl(fuzz::text(data, size), fuzz::small_limits()));
    } catch (const Error&) {
    }
    return 0;
}
