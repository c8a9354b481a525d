#include "server/worker/run_job.h"

#include <new>

#include "core/export/write_model.h"
#include "core/export/write_svg.h"
#include "server/problem_map.h"
#include "server/translate.h"

namespace lastflat::server {

namespace {

std::unique_ptr<const JobOutput> render(const FlattenResult& result) {
    const api::FlattenResult wire = to_wire(result);
    return std::make_unique<const JobOutput>(
        JobOutput{api::to_json(wire), write_svg(result), write_flat_glb(result),
                  write_flat_obj(result), api::metrics_json(wire)});
}

}  // namespace

RunOutcome run_job(const JobInput& input, Progress& progress) {
    try {
        return {render(flatten(input.model, input.options, progress)), std::nullopt};
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
