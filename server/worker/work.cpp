#include "server/worker/work.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "api/flatten_request.h"
#include "api/problem_json.h"
#include "server/jobs/result_parts.h"
#include "server/protocol/result_pack.h"
#include "server/protocol/work_messages.h"
#include "server/support/crypto.h"
#include "server/support/files.h"
#include "server/worker/inspect_job.h"
#include "server/worker/map_job.h"
#include "server/worker/problem_map.h"

namespace lastflat::server {
namespace {

using Json = nlohmann::ordered_json;

/// Below the service: its answers come before our triangles.
constexpr int niceness = 10;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool memory_can_be_limited = false;  // sanitizers map terabytes of shadow
#else
constexpr bool memory_can_be_limited = true;
#endif

void limit(int resource, std::uint64_t most) {
    const rlimit limits{most, most};
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
    if (order.cpu_seconds > 0) limit(RLIMIT_CPU, static_cast<std::uint64_t>(order.cpu_seconds));
    if (order.memory_mb > 0 && memory_can_be_limited)
        limit(RLIMIT_DATA, static_cast<std::uint64_t>(order.memory_mb) << 20);
    [[maybe_unused]] const int now = nice(niceness);
}

void say(const Json& message) {
    const std::string line = message.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
    std::cout << line << std::flush;
}

void say_problem(const api::Problem& problem) {
    say({{"problem", api::problem_json(problem)}});
}

std::string read_model(const WorkOrder& order) {
    const File file(order.model, O_RDONLY);
    std::string model = file.read(0, file.size());
    if (sha256(model) != order.digest) throw StoreError("its bytes have changed on the disk");
    return model;
}

void flatten(const WorkOrder& order, const JobInput& input) {
    Progress progress([](Stage stage, double fraction) {
        say({{"stage", name(stage)}, {"fraction", fraction}});
    });
    const RunOutcome outcome = run_job(input, Compression::gzip, progress);
    if (!outcome.output) return say_problem(outcome.error.value());
    try {
        const ResultPack pack = write_result_pack(*outcome.output, order.result);
        say({{"digest", pack.digest}, {"parts", Json::parse(to_json(pack.parts))}});
    } catch (const StoreError& error) {
        ::unlink(order.result.c_str());
        say({{"retry", error.what()}});
    }
}

void work(const WorkOrder& order) {
    JobInput input;
    try {
        if (order.task == Task::map) return say(map_job(read_model(order), order.request));
        input.options.request = api::flatten_request_from_json(order.request).asked;
        input.options.threads = static_cast<std::size_t>(order.threads);
        input.model = read_model(order);
    } catch (const api::InvalidRequest& error) {
        return say_problem(problem_of(error));
    } catch (const Error& error) {
        return say_problem(problem_of(error));
    } catch (const StoreError& error) {
        return say_problem(
            {500, "model_lost", "",
             std::string("the model cannot be read back: ") + error.what() + "; post the job again",
             std::nullopt, std::nullopt});
    }
    if (order.task == Task::inspect) return say(inspect_job(input));
    flatten(order, input);
}

}  // namespace

void work_command() {
    std::string line;
    std::getline(std::cin, line);
    const WorkOrder order = work_order_of(line);
    limit_self(order);
    work(order);
    // All is said and on the disk; giving the memory back piece by piece would only take time.
    std::_Exit(0);
}

}  // namespace lastflat::server
