#include "server/runner/worker_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <thread>

#include "server/support/descriptor.h"
#include "server/support/version.h"

namespace lastflat::server {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int look_ms = 50;
constexpr std::size_t most_message_bytes = 64u << 20;
constexpr std::size_t most_said_bytes = 4096;
constexpr std::chrono::seconds time_to_end{5};

struct Pipe {
    Pipe() : Pipe(make()) {}
    Descriptor from, to;

private:
    explicit Pipe(std::array<int, 2> ends) : from(ends[0]), to(ends[1]) {}
    static std::array<int, 2> make() {
        std::array<int, 2> ends{};
        if (::pipe2(ends.data(), O_CLOEXEC) != 0)
            throw std::system_error(errno, std::generic_category(), "pipe2");
        ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
        return ends;
    }
};

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

pid_t spawn(const std::string& program, int in, int out, int errors) {
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    posix_spawn_file_actions_adddup2(&actions, in, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, errors, STDERR_FILENO);
    sigset_t none;
    sigemptyset(&none);
    sigset_t all;
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    // A group of its own: the terminal's Ctrl-C is for the service, which then decides.
    posix_spawnattr_setflags(
        &attributes,
        static_cast<short>(POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP));
    std::string name = "lastflat-work";
    std::array<char*, 2> arguments{name.data(), nullptr};
    std::array<char*, 1> environment{nullptr};
    pid_t process = -1;
    const int error = ::posix_spawn(&process, program.c_str(), &actions, &attributes,
                                    arguments.data(), environment.data());
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) throw std::system_error(error, std::generic_category(), "posix_spawn");
    return process;
}

/// A started worker: ended and waited for at the latest when this goes.
class Worker {
public:
    Worker(const WorkOrder& order, const std::string& program) {
        const Descriptor in = order_file(order);
        process_ = spawn(program, in.fd(), messages_.to.fd(), errors_.to.fd());
        messages_.to.close();
        errors_.to.close();
    }
    ~Worker() {
        if (process_ > 0) {
            kill();
            (void)wait();
        }
    }
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    /// With whatever it has started.
    void kill() const { ::kill(-process_, SIGKILL); }

    /// Reads what is there; false at the end of both streams.
    [[nodiscard]] bool read() {
        std::array<pollfd, 2> watched{
            {{messages_.from.fd(), POLLIN, 0}, {errors_.from.fd(), POLLIN, 0}}};
        ::poll(watched.data(), watched.size(), look_ms);
        if (watched[0].revents != 0) take(messages_.from, messages);
        if (watched[1].revents != 0) take(errors_.from, said);
        if (said.size() > most_said_bytes) said.resize(most_said_bytes);
        return messages_.from.fd() >= 0 || errors_.from.fd() >= 0;
    }
    /// The status of `waitpid`.
    [[nodiscard]] int wait() {
        int status = 0;
        while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
        }
        process_ = -1;
        return status;
    }

    /// The same once both streams have ended; who does not end with them is killed.
    [[nodiscard]] int wait_briefly() {
        const auto deadline = Clock::now() + time_to_end;
        int status = 0;
        while (Clock::now() < deadline) {
            if (::waitpid(process_, &status, WNOHANG) == process_) {
                process_ = -1;
                return status;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        kill();
        return wait();
    }

    std::string messages;  ///< not yet taken
    std::string said;      ///< on standard error

private:
    static void take(Descriptor& from, std::string& into) {
        std::array<char, 64u << 10> step;
        const ssize_t got = ::read(from.fd(), step.data(), step.size());
        if (got > 0) into.append(step.data(), static_cast<std::size_t>(got));
        if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) from.close();
    }

    Pipe messages_, errors_;
    pid_t process_ = -1;
};

class Supervision {
public:
    Supervision(Worker& worker, const ProcessControl& control)
        : worker_(worker), control_(control) {}

    /// Takes the complete lines. False: what comes is no message.
    [[nodiscard]] bool follow() {
        std::size_t begin = 0;
        for (std::size_t end; (end = worker_.messages.find('\n', begin)) != std::string::npos;
             begin = end + 1) {
            auto message =
                work_message_of(std::string_view(worker_.messages).substr(begin, end - begin));
            if (!message) return false;
            std::visit([this](auto& said) { take(said); }, *message);
        }
        worker_.messages.erase(0, begin);
        return worker_.messages.size() <= most_message_bytes;
    }

    [[nodiscard]] ProcessEnd ended(int status) {
        if (result_) return std::move(*result_);
        Unfinished end;
        end.why = WIFSIGNALED(status) ? std::string("signal ") + ::strsignal(WTERMSIG(status))
                                      : "exit code " + std::to_string(WEXITSTATUS(status));
        if (!worker_.said.empty()) end.why += ": " + worker_.said;
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

    Worker& worker_;
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
    Worker worker(order, limits.program);
    Supervision supervision(worker, control);
    using Kind = Unfinished::Kind;
    const auto stop = [&](Kind kind, const char* why) {
        worker.kill();
        return Unfinished{kind, why};
    };
    while (worker.read()) {
        if (!supervision.follow()) return stop(Kind::crashed, "it said nonsense");
        if (control.must_stop()) return stop(Kind::stopped, "");
        if (Clock::now() > deadline) return stop(Kind::timed_out, "");
    }
    if (!supervision.follow()) return stop(Kind::crashed, "it said nonsense");
    return supervision.ended(worker.wait_briefly());
}

}  // namespace lastflat::server
