#include "server/runner/in_worker.h"

#include <unistd.h>

#include <algorithm>
#include <thread>

#include "server/support/crypto.h"
#include "server/support/files.h"
#include "server/support/scope_exit.h"
#include "server/support/turns.h"

namespace lastflat::server {
namespace {

constexpr int most_tasks = 2;

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
    const auto turns = std::make_shared<Turns>(most_tasks);
    return [turns, work, ends = std::move(ends), limits](const TaskCall& call) {
        const auto is_over = [&] { return ends() || call.is_unwanted(); };
        if (!turns->enter(call.owner, is_over))
            return ProcessEnd(Unfinished{Unfinished::Kind::stopped, {}});
        const ScopeExit leave([&] { turns->leave(call.owner); });
        const std::filesystem::path file = work / ("task-" + new_job_id());
        const ScopeExit clear([&] { unlink(file.c_str()); });
        write_durably(file, call.model);
        WorkOrder order;
        order.task = call.task;
        order.digest = sha256(call.model);
        order.model = file;
        order.request = call.request;
        order.threads = hardware_threads();
        return run_worker_process(std::move(order), limits,
                                  {[](const std::string&, double) {}, is_over});
    };
}

}  // namespace lastflat::server
