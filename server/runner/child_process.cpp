#include "server/runner/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <system_error>
#include <thread>

namespace lastflat::server {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t most_said_bytes = 4096;
constexpr std::chrono::seconds time_to_end{5};

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

void take(Descriptor& from, std::string& into) {
    std::array<char, 64u << 10> step;
    const ssize_t got = ::read(from.fd(), step.data(), step.size());
    if (got > 0) into.append(step.data(), static_cast<std::size_t>(got));
    if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) from.close();
}

}  // namespace

Pipe::Pipe() {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0)
        throw std::system_error(errno, std::generic_category(), "pipe2");
    from = Descriptor(ends[0]);
    to = Descriptor(ends[1]);
}

ChildProcess::ChildProcess(const std::string& program, const Descriptor& in)
    : process_(spawn(program, in.fd(), output_.to.fd(), errors_.to.fd())) {
    output_.to.close();
    errors_.to.close();
    ::fcntl(output_.from.fd(), F_SETFL, O_NONBLOCK);
    ::fcntl(errors_.from.fd(), F_SETFL, O_NONBLOCK);
}

ChildProcess::~ChildProcess() {
    if (process_ > 0) {
        kill();
        (void)wait();
    }
}

void ChildProcess::kill() const {
    if (process_ > 0) ::kill(-process_, SIGKILL);
}

int ChildProcess::wait() {
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    return status;
}

int ChildProcess::wait_briefly() {
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

bool ChildProcess::read(int milliseconds) {
    std::array<pollfd, 2> watched{{{output_.from.fd(), POLLIN, 0}, {errors_.from.fd(), POLLIN, 0}}};
    ::poll(watched.data(), watched.size(), milliseconds);
    if (watched[0].revents != 0) take(output_.from, output);
    if (watched[1].revents != 0) take(errors_.from, errors);
    if (errors.size() > most_said_bytes) errors.resize(most_said_bytes);
    return output_.from.is_open() || errors_.from.is_open();
}

std::string reason_of(int status, const std::string& errors) {
    std::string why = WIFSIGNALED(status) ? std::string("signal ") + ::strsignal(WTERMSIG(status))
                                          : "exit code " + std::to_string(WEXITSTATUS(status));
    if (!errors.empty()) why += ": " + errors;
    return why;
}

}  // namespace lastflat::server
