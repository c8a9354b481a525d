#include "server/run_job.h"

#include <new>

#include "core/export/write_model.h"
#include "core/export/write_svg.h"
#include "server/problem_map.h"
#include "server/translate.h"

namespace lastflat::server {

std::shared_ptr<const JobOutput> render(const FlattenResult& result) {
    const auto share = [](std::string bytes) {
        return std::make_shared<const std::string>(std::move(bytes));
    };
    return std::make_shared<const JobOutput>(
        JobOutput{share(api::to_json(to_wire(result))), share(write_svg(result)),
                  share(write_flat_glb(result)), share(write_flat_obj(result))});
}

JobOutcome run_job(const JobInput& input, Progress& progress) {
    try {
        return {render(flatten(*input.model, input.options, progress)), std::nullopt};
    } catch (const Error& error) {
        if (error.code() == ErrorCode::cancelled) return {};
        return {nullptr, problem_of(error)};
    } catch (const std::bad_alloc&) {
        return {nullptr,
                api::Problem{413, "out_of_memory", "",
                             "the model needs more memory than there is; send a coarser one",
                             std::nullopt, std::nullopt}};
    } catch (const std::exception& error) {
        return {nullptr, api::Problem{500, "internal_error", "",
                                      std::string("an internal error: ") + error.what(),
                                      std::nullopt, std::nullopt}};
    }
}

}  // namespace lastflat::server
