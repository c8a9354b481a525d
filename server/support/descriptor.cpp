#include "server/support/descriptor.h"

#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace lastflat::server {

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
    if (this != &other) {
        close();
        fd_ = other.release();
    }
    return *this;
}

void Descriptor::close() {
    if (fd_ >= 0) ::close(release());
}

Descriptor checked(int fd, const char* call) {
    if (fd < 0) throw std::system_error(errno, std::generic_category(), call);
    return Descriptor(fd);
}

}  // namespace lastflat::server
