// Any bytes as a model of unknown format: glTF, GLB, or whatever else they look like.
#include "tests/fuzz/mesh_checks.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lastflat;
    try {
        fuzz::check(load_model(fuzz::text(data, size), fuzz::small_limits()));
    } catch (const Error&) {
    }
    return 0;
}
