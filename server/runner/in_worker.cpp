#include "server/runner/in_worker.h"

#include <unistd.h>

#include <algorithm>
#include <semaphore>
#include <thread>

#include "server/support/crypto.h"
#include "server/support/files.h"
#include "server/support/scope_exit.h"

namespace lastflat::server {
namespace {

constexpr int most_tasks = 2;
constexpr std::chrono::milliseconds look_every{100};

}  // namespace

int hardware_threads() {
    return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

RunJob run_jobs_in_workers(const ProcessLimits& limits, const BlobStore& blobs) {
    return [&blobs, limits](const Claim& claim, const std::filesystem::path& file,
                            const ProcessControl& control) {
        WorkOrder order;
        order.model = blobs.path_of(claim.model);
        order.digest = claim.model;
        order.request = claim.request;
        order.result = file;
        order.threads = hardware_threads();
        return run_worker_process(std::move(order), limits, control);
    };
}

RunTask run_tasks_in_workers(const ProcessLimits& limits, const std::filesystem::path& work,
                             std::function<bool()> ends) {
    const auto slots = std::make_shared<std::counting_semaphore<>>(most_tasks);
    return [slots, work, ends = std::move(ends), limits](Task task, std::string_view model,
                                                         std::string_view request) {
        while (!slots->try_acquire_for(look_every)) {
            if (ends()) return ProcessEnd(Unfinished{Unfinished::Kind::stopped, {}});
        }
        const std::filesystem::path file = work / ("task-" + new_job_id());
        const ScopeExit clear([&] {
            unlink(file.c_str());
            slots->release();
        });
        write_durably(file, model);
        WorkOrder order;
        order.task = task;
        order.digest = sha256(model);
        order.model = file;
        order.request = request;
        order.threads = hardware_threads();
        return run_worker_process(std::move(order), limits,
                                  {[](const std::string&, double) {}, ends});
    };
}

}  // namespace lastflat::server
