#include "server/worker/work.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <iostream>

#include "api/base64.h"
#include "api/flatten_request.h"
#include "api/model_report.h"
#include "api/problem_of.h"
#include "api/refusal.h"
#include "core/inspect.h"
#include "server/protocol/result_pack.h"
#include "server/protocol/work_messages.h"
#include "server/support/crypto.h"
#include "server/support/files.h"
#include "server/worker/run_job.h"
#include "server/worker/session_loop.h"
#include "server/worker/thumbnail.h"

namespace lastflat::server {
namespace {

/// Below the service: its answers come before our triangles; above jobs: somebody looks on.
constexpr int niceness = 10, niceness_to_look_on = 5;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool memory_can_be_limited = false;  // sanitizers map terabytes of shadow
#else
constexpr bool memory_can_be_limited = true;
#endif

constexpr std::uint64_t cpu_grace = 2;  // seconds

/// What goes beyond is told so by a signal, and `grace` later by one that cannot be ignored.
void limit(int resource, std::uint64_t most, std::uint64_t grace = 0) {
    const rlimit limits{most, most + grace};
    setrlimit(static_cast<__rlimit_resource>(resource), &limits);
}

/// Before a byte of the model is read.
void limit_self(const WorkOrder& order) {
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != order.parent) std::_Exit(1);  // it ended before we could ask for the signal
    // Sockets that the service opened in the moment between two calls do not belong here.
    close_range(3, ~0u, 0);
    limit(RLIMIT_CORE, 0);
    if (order.cpu_seconds > 0)
        limit(RLIMIT_CPU, static_cast<std::uint64_t>(order.cpu_seconds), cpu_grace);
    if (order.memory_mb > 0 && memory_can_be_limited)
        limit(RLIMIT_DATA, static_cast<std::uint64_t>(order.memory_mb) << 20);
    const bool stays = order.task == Task::session || order.task == Task::resident_map;
    [[maybe_unused]] const int now = nice(stays ? niceness_to_look_on : niceness);
}

void say(const WorkMessage& message) {
    std::cout << to_line(message) << std::flush;
}

std::string read_model(const WorkOrder& order) try {
    const File file(order.model, O_RDONLY);
    std::string model = file.read(0, file.size());
    if (sha256(model) != order.digest) throw StoreError("its bytes have changed on the disk");
    return model;
} catch (const StoreError& error) {
    api::refuse("model_lost", std::string("the model cannot be read back: ") + error.what() +
                                  "; post the job again");
}

WorkMessage run_flatten(const WorkOrder& order, const JobInput& input) {
    Progress progress([](Stage stage, double fraction) {
        say(StageReached{std::string(name(stage)), fraction});
    });
    const JobOutput output = run_job(input, progress);
    try {
        return write_result_pack(output, order.result);
    } catch (const StoreError& error) {
        ::unlink(order.result.c_str());
        return Retry{error.what()};
    }
}

WorkMessage work(const WorkOrder& order) {
    if (order.task == Task::session) session_loop(order, read_model(order));
    if (order.task == Task::resident_map) map_loop(read_model(order));
    if (order.task == Task::thumbnail) {
        (void)read_model(order);  // it is what it was
        return Report{api::encode_base64(thumbnail(order.model, std::stoi(order.request)))};
    }
    JobInput input;
    input.options.request = api::flatten_request_from_json(order.request).asked;
    input.options.threads = static_cast<std::size_t>(order.threads);
    input.model = read_model(order);
    if (order.task == Task::flatten) return run_flatten(order, input);
    return Report{api::to_json(inspect(input.model, input.options))};
}

WorkMessage ended(const WorkOrder& order) {
    try {
        return work(order);
    } catch (...) {
        return Failed{api::problem_of(std::current_exception())};
    }
}

}  // namespace

void work_command() {
    std::string line;
    std::getline(std::cin, line);
    const WorkOrder order = work_order_of(line);
    limit_self(order);
    say(ended(order));
    // All is said and on the disk; giving the memory back piece by piece would only take time.
    std::_Exit(0);
}

}  // namespace lastflat::server
