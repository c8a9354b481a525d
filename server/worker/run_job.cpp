#include "server/worker/run_job.h"

#include <future>
#include <new>

#include "api/flatten_result.h"
#include "core/export/write_model.h"
#include "core/export/write_svg.h"
#include "server/support/version.h"
#include "server/worker/gzip.h"
#include "server/worker/problem_map.h"

namespace lastflat::server {

namespace {

Rendered rendered(std::string bytes, Compression compression) {
    Rendered both{std::move(bytes), {}};
    if (compression == Compression::gzip) both.gzip = gzip(both.bytes);
    return both;
}

/// Each format on a thread of its own: together they take about as long as a small job.
std::unique_ptr<const JobOutput> render(const FlattenResult& result, Compression compression) {
    const auto begin = [&](auto write) {
        return std::async(std::launch::async, [=] { return rendered(write(), compression); });
    };
    auto obj = begin([&] { return write_flat_obj(result); });
    auto svg = begin([&] { return write_svg(result); });
    auto glb = begin([&] { return write_flat_glb(result); });
    auto output = std::make_unique<JobOutput>();
    output->json = rendered(api::to_json(result, version), compression);
    output->metrics = rendered(api::metrics_json(result, version), compression);
    output->svg = svg.get();
    output->obj = obj.get();
    output->glb = glb.get();
    return output;
}

}  // namespace

RunOutcome run_job(const JobInput& input, Compression compression, Progress& progress) {
    try {
        return {render(flatten(input.model, input.options, progress), compression), std::nullopt};
    } catch (const Error& error) {
        if (error.code() == ErrorCode::cancelled) return {};
        return {nullptr, problem_of(error)};
    } catch (const std::bad_alloc&) {
        return {nullptr, out_of_memory()};
    } catch (const std::exception& error) {
        return {nullptr, api::Problem{500, "internal_error", "",
                                      std::string("an internal error: ") + error.what(),
                                      std::nullopt, std::nullopt}};
    }
}

}  // namespace lastflat::server
