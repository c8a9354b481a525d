// Jobs and validations as worker processes, under the limits that the operator has set.
#pragma once

#include "server/runner/worker_pool.h"

namespace lastflat::server {

/// `blobs` must outlive the runner.
[[nodiscard]] JobRunner job_runner(const ProcessLimits& limits, const BlobStore& blobs);

/// A short task in a process of its own: a validation, or a mapping.
using TaskRunner =
    std::function<ProcessEnd(Task task, const std::string& model, const std::string& request)>;

/// Few at once, others wait: each may use as much as a job. `work`: a folder for the models.
/// Once `ends` says so they end at once, as stopped.
[[nodiscard]] TaskRunner task_runner(const ProcessLimits& limits, const std::filesystem::path& work,
                                     std::function<bool()> ends);

[[nodiscard]] int hardware_threads();

}  // namespace lastflat::server
