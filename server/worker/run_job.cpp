#include "server/worker/run_job.h"

#include <future>

#include "api/flatten_result.h"
#include "core/export/write_flat_glb.h"
#include "core/export/write_model.h"
#include "core/export/write_svg.h"
#include "server/support/gzip.h"
#include "server/support/version.h"

namespace lastflat::server {
namespace {

Rendered rendered(std::string bytes, Compression compression) {
    Rendered both{std::move(bytes), {}};
    if (compression == Compression::gzip) both.gzip = gzip(both.bytes);
    return both;
}

}  // namespace

JobOutput render(const FlattenResult& result, Compression compression) {
    // Each format on a thread of its own: together they take about as long as a small job.
    const auto begin = [&](auto write) {
        return std::async(std::launch::async, [=] { return rendered(write(), compression); });
    };
    auto obj = begin([&] { return write_flat_obj(result); });
    auto svg = begin([&] { return write_svg(result); });
    auto glb = begin([&] { return write_flat_glb(result); });
    JobOutput output;
    output.json = rendered(api::to_json(result, version), compression);
    output.metrics = rendered(api::metrics_json(result, version), compression);
    output.svg = svg.get();
    output.obj = obj.get();
    output.glb = glb.get();
    return output;
}

JobOutput run_job(const JobInput& input, Compression compression, Progress& progress) {
    return render(flatten(input.model, input.options, progress), compression);
}

}  // namespace lastflat::server
