// Jobs and tasks in workers, under the limits that the operator has set.
#pragma once

#include "server/runner/runner_pool.h"

namespace lastflat::server {

/// `blobs` must outlive what is returned.
[[nodiscard]] RunJob run_jobs_in_workers(const ProcessLimits& limits, const BlobStore& blobs);

/// A short task in a worker of its own: an inspection, a picture.
struct TaskCall {
    std::string owner;  ///< who asks for it
    Task task = Task::inspect;
    std::string_view model, request;
    std::function<bool()> is_unwanted;  ///< nobody waits for it any more
};
using RunTask = std::function<ProcessEnd(const TaskCall& call)>;

/// Few at once, others wait, and owners take turns: each may use as much as a job. `work`: a folder
/// for the models. Once `ends` says so they end at once, as stopped; so does what is unwanted.
[[nodiscard]] RunTask run_tasks_in_workers(const ProcessLimits& limits,
                                           const std::filesystem::path& work,
                                           std::function<bool()> ends);

[[nodiscard]] int hardware_threads();

}  // namespace lastflat::server
