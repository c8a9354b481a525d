#include "server/worker/thumbnail.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "server/support/descriptor.h"

namespace lastflat::server {
namespace {

constexpr int most_high = 4;  ///< widths

[[noreturn]] void fail(const std::string& what, int code) {
    throw std::system_error(code, std::generic_category(), what);
}

std::string read_all(int descriptor) {
    std::string bytes;
    std::array<char, 1u << 16> block;
    for (;;) {
        const ssize_t got = ::read(descriptor, block.data(), block.size());
        if (got < 0 && errno != EINTR) fail("the picture cannot be read", errno);
        if (got == 0) return bytes;
        if (got > 0) bytes.append(block.data(), static_cast<std::size_t>(got));
    }
}

}  // namespace

std::string thumbnail(const std::string& svg_file, int width) {
    std::array<int, 2> ends{};
    (void)checked(::pipe2(ends.data(), O_CLOEXEC), "pipe2").release();
    const Descriptor from(ends[0]);
    Descriptor to(ends[1]);
    std::string wide = std::to_string(width), high = std::to_string(most_high * width);
    std::string file = svg_file, program = "rsvg-convert", keep = "--keep-aspect-ratio",
                width_is = "--width", height_is = "--height";
    std::array<char*, 8> arguments{program.data(),   keep.data(), width_is.data(), wide.data(),
                                   height_is.data(), high.data(), file.data(),     nullptr};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, to.fd(), STDOUT_FILENO);
    pid_t process = -1;
    const int failed =
        posix_spawnp(&process, program.c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) fail("rsvg-convert (package librsvg2-bin) cannot be started", failed);
    to.close();
    std::string png = read_all(from.fd());
    int status = 0;
    while (::waitpid(process, &status, 0) < 0) {
        if (errno != EINTR) fail("rsvg-convert is gone", errno);
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw std::runtime_error("rsvg-convert cannot draw the result");
    return png;
}

}  // namespace lastflat::server
