// Any bytes as a constraint JSON, alone and beside a model, and as what is to be mapped. An error
// must name a JSON pointer, and a problem document must be able to carry its text.
#include "api/flatten_request.h"
#include "api/map.h"
#include "api/object_reader.h"
#include "api/submission.h"
#include "tests/fuzz/mesh_checks.h"

namespace {

using namespace lastflat;

api::RequestLimits small_limits() {
    api::RequestLimits limits;
    limits.curves = 16;
    limits.curve_vertices = 64;
    limits.regions = 8;
    limits.list = 32;
    return limits;
}

template <class Read>
void read_or_refuse(const Read& read) {
    try {
        (void)read();
    } catch (const api::InvalidRequest& error) {
        fuzz::require(error.pointer().empty() || error.pointer().front() == '/');
        fuzz::require(nlohmann::json::accept(api::to_json(error.problem())));
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto text = fuzz::text(data, size);
    read_or_refuse([&] { return api::flatten_request_from_json(text, small_limits()); });
    read_or_refuse([&] { return api::json_submission_from_json(text, small_limits()); });
    read_or_refuse([&] { return api::map_request_from_json(text); });
    return 0;
}
