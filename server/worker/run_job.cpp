#include "server/worker/run_job.h"

#include <future>

#include "api/flatten_result.h"
#include "core/export/write_flat_glb.h"
#include "core/export/write_model.h"
#include "core/export/write_svg.h"
#include "server/support/version.h"

namespace lastflat::server {
JobOutput render(const FlattenResult& result) {
    // Each format on a thread of its own: together they take about as long as a small job.
    const auto begin = [](auto write) { return std::async(std::launch::async, write); };
    auto obj = begin([&] { return write_flat_obj(result); });
    auto svg = begin([&] { return write_svg(result); });
    auto glb = begin([&] { return write_flat_glb(result); });
    JobOutput output;
    output.json = api::to_json(result, version);
    output.metrics = api::metrics_json(result, version);
    output.svg = svg.get();
    output.obj = obj.get();
    output.glb = glb.get();
    return output;
}

JobOutput run_job(const JobInput& input, Progress& progress) {
    return render(flatten(input.model, input.options, progress));
}

}  // namespace lastflat::server
