// A process of the worker's program, and the pipes to it.
#pragma once

#include <sys/types.h>

#include <string>

#include "server/support/descriptor.h"

namespace lastflat::server {

/// Both ends close when a program is started. Throws: std::system_error.
struct Pipe {
    Pipe();
    Descriptor from, to;
};

/// Started in a group of its own, with an empty environment and default signals: the terminal's
/// Ctrl-C is for the service, which then decides. Ended and waited for at the latest when this
/// goes.
class ChildProcess {
public:
    /// `in`: its standard input. Throws: std::system_error.
    ChildProcess(const std::string& program, const Descriptor& in);
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    /// With whatever it has started. Nothing if it was waited for.
    void kill() const;

    /// The status of `waitpid`.
    [[nodiscard]] int wait();
    /// The same once both streams have ended; who does not end with them is killed.
    [[nodiscard]] int wait_briefly();

    /// Waits so long at most for something on either stream and puts it behind what is there; false
    /// at the end of both.
    [[nodiscard]] bool read(int milliseconds);

    std::string output{}, errors{};  ///< not yet taken; of the errors only the beginning is kept

private:
    Pipe output_, errors_;
    pid_t process_ = -1;
};

/// Why it ended, for the operator.
[[nodiscard]] std::string reason_of(int status, const std::string& errors);

}  // namespace lastflat::server
