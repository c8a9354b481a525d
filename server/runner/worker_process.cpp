#include "server/runner/worker_process.h"

#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "server/runner/child_process.h"
#include "server/support/version.h"

namespace lastflat::server {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int look_ms = 50;
constexpr std::size_t most_message_bytes = 64u << 20;

/// A file without a name: a pipe would block on a worker that does not read.
Descriptor order_file(const WorkOrder& order) {
    Descriptor file = checked(::memfd_create("order", MFD_CLOEXEC), "memfd_create");
    const std::string line = to_line(order);
    std::size_t done = 0;
    while (done < line.size()) {
        const ssize_t written = ::write(file.fd(), line.data() + done, line.size() - done);
        if (written <= 0) throw std::system_error(errno, std::generic_category(), "write");
        done += static_cast<std::size_t>(written);
    }
    ::lseek(file.fd(), 0, SEEK_SET);
    return file;
}

class Supervision {
public:
    Supervision(ChildProcess& worker, const ProcessControl& control)
        : worker_(worker), control_(control) {}

    /// Takes the complete lines. False: what comes is no message.
    [[nodiscard]] bool follow() {
        std::size_t begin = 0;
        for (std::size_t end; (end = worker_.output.find('\n', begin)) != std::string::npos;
             begin = end + 1) {
            auto message =
                work_message_of(std::string_view(worker_.output).substr(begin, end - begin));
            if (!message) return false;
            std::visit([this](auto& said) { take(said); }, *message);
        }
        worker_.output.erase(0, begin);
        return worker_.output.size() <= most_message_bytes;
    }

    [[nodiscard]] ProcessEnd ended(int status) {
        if (result_) return std::move(*result_);
        Unfinished end;
        end.why = reason_of(status, worker_.errors);
        if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
            end.kind = Unfinished::Kind::timed_out;
        // Nobody but the kernel, short of memory, or an operator ends a worker like that.
        if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) end.kind = Unfinished::Kind::lost;
        return end;
    }

private:
    void take(StageReached& reached) { control_.on_progress(reached.stage, reached.fraction); }
    void take(Retry& retry) { result_ = Unfinished{Unfinished::Kind::retry, std::move(retry.why)}; }
    template <class End>
    void take(End& end) {
        result_ = std::move(end);
    }

    ChildProcess& worker_;
    const ProcessControl& control_;
    std::optional<ProcessEnd> result_;
};

}  // namespace

std::string worker_program() {
    const auto folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
    const auto built = folder / "lastflat-work";
    return std::filesystem::exists(built) ? built : folder / installed_worker;
}

ProcessEnd run_worker_process(WorkOrder order, const ProcessLimits& limits,
                              const ProcessControl& control) {
    order.memory_mb = limits.memory_mb;
    // A second line of defence, for when this process is frozen: it looks at no clock then.
    order.cpu_seconds =
        static_cast<int>(limits.time / std::chrono::seconds(1) + 1) * std::max(1, order.threads);
    order.parent = ::getpid();
    const auto deadline = Clock::now() + limits.time;
    ChildProcess worker(limits.program, order_file(order));
    Supervision supervision(worker, control);
    using Kind = Unfinished::Kind;
    const auto stop = [&](Kind kind, const char* why) {
        worker.kill();
        return Unfinished{kind, why};
    };
    while (worker.read(look_ms)) {
        if (!supervision.follow()) return stop(Kind::crashed, "it said nonsense");
        if (control.must_stop()) return stop(Kind::stopped, "");
        if (Clock::now() > deadline) return stop(Kind::timed_out, "");
    }
    if (!supervision.follow()) return stop(Kind::crashed, "it said nonsense");
    return supervision.ended(worker.wait_briefly());
}

}  // namespace lastflat::server
