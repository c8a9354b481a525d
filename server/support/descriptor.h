// The one owner of a file descriptor, be it a file, a pipe or a socket.
#pragma once

#include <utility>

namespace lastflat::server {

/// Closes what it owns.
class Descriptor {
public:
    Descriptor() = default;
    explicit Descriptor(int fd) : fd_(fd) {}
    ~Descriptor() { close(); }
    Descriptor(Descriptor&& other) noexcept : fd_(other.release()) {}
    Descriptor& operator=(Descriptor&& other) noexcept;

    [[nodiscard]] int fd() const { return fd_; }
    [[nodiscard]] bool is_open() const { return fd_ >= 0; }
    int release() { return std::exchange(fd_, -1); }
    void close();

private:
    int fd_ = -1;
};

/// Owns what a system call returned. Throws: std::system_error naming the call if it failed.
[[nodiscard]] Descriptor checked(int fd, const char* call);

}  // namespace lastflat::server
