// A worker as the service sees it.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <variant>

#include "server/protocol/work_messages.h"

namespace lastflat::server {

/// The program of the workers, `lastflat-work`: beside the running program, as it is built, or
/// where it is installed.
[[nodiscard]] std::string worker_program();

struct ProcessLimits {
    std::string program = worker_program();
    int memory_mb = 4096;  ///< 0: no limit
    std::chrono::milliseconds time{300'000};
};

/// A run that came to no end of its own.
struct Unfinished {
    enum class Kind {
        retry,  ///< not the job's fault
        lost,   ///< somebody killed it
        crashed,
        timed_out,
        stopped  ///< because `must_stop` said so
    };
    Kind kind = Kind::crashed;
    std::string why;  ///< for the operator
};
using ProcessEnd = std::variant<Succeeded, Failed, Report, Unfinished>;

struct ProcessControl {
    std::function<void(const std::string& stage, double fraction)> on_progress;
    /// Asked about 20 times a second; true ends the process at once.
    std::function<bool()> must_stop;
};

/// Runs one order to its end. Whatever the process does, this returns.
[[nodiscard]] ProcessEnd run_worker_process(WorkOrder order, const ProcessLimits& limits,
                                            const ProcessControl& control);

}  // namespace lastflat::server
