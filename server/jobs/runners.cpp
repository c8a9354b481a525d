#include "server/jobs/runners.h"

#include <unistd.h>

#include <algorithm>
#include <semaphore>
#include <thread>

#include "server/crypto.h"

namespace lastflat::server {
namespace {

constexpr int most_validations = 2;

ProcessLimits process_limits(const Settings& settings) {
    ProcessLimits limits;
    limits.memory_mb = settings.job_memory_mb;
    limits.time = std::chrono::milliseconds(settings.job_time_ms);
    return limits;
}

}  // namespace

int hardware_threads() {
    return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

JobRunner job_runner(const Settings& settings, const BlobStore& blobs) {
    return
        [&blobs, limits = process_limits(settings)](
            const Claim& claim, const std::filesystem::path& file, const ProcessControl& control) {
            WorkOrder order;
            order.model = blobs.path_of(claim.model);
            order.digest = claim.model;
            order.request = claim.request;
            order.result = file;
            order.threads = hardware_threads();
            return run_worker_process(std::move(order), limits, control);
        };
}

Validator validator(const Settings& settings, const std::filesystem::path& work) {
    const auto slots = std::make_shared<std::counting_semaphore<>>(most_validations);
    return [slots, work, limits = process_limits(settings)](const std::string& model,
                                                            const std::string& request) {
        slots->acquire();
        const std::unique_ptr<void, std::function<void(void*)>> at_end(
            slots.get(), [&](void*) { slots->release(); });
        WorkOrder order;
        order.validate = true;
        order.digest = sha256(model);
        order.model = work / ("validate-" + new_job_id());
        order.request = request;
        order.threads = hardware_threads();
        write_durably(order.model, model);
        const std::string file = order.model;
        ProcessEnd end = run_worker_process(
            std::move(order), limits, {[](const std::string&, double) {}, [] { return false; }});
        unlink(file.c_str());
        return end;
    };
}

}  // namespace lastflat::server
