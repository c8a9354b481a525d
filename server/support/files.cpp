#include "server/support/files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>

namespace lastflat::server {

namespace fs = std::filesystem;

File::File(const fs::path& path, int flags, int mode)
    : path_(path), descriptor_(::open(path.c_str(), flags | O_CLOEXEC, mode)) {
    if (!descriptor_.is_open()) fail("cannot open");
}

void File::fail(const char* what) const {
    throw StoreError(std::string(what) + " " + path_.string() + ": " + std::strerror(errno));
}

void File::write(std::string_view bytes) const {
    while (!bytes.empty()) {
        const ssize_t done = ::write(fd(), bytes.data(), bytes.size());
        if (done < 0 && errno == EINTR) continue;
        if (done < 0) fail("cannot write");
        bytes.remove_prefix(static_cast<std::size_t>(done));
    }
}

void File::sync() const {
    if (::fsync(fd()) != 0) fail("cannot sync");
}

std::size_t File::size() const {
    struct stat status {};
    if (::fstat(fd(), &status) != 0) fail("cannot look at");
    return static_cast<std::size_t>(status.st_size);
}

std::string File::read(std::size_t offset, std::size_t size) const {
    std::string bytes(size, '\0');
    std::size_t done = 0;
    while (done < size) {
        const ssize_t got =
            ::pread(fd(), bytes.data() + done, size - done, static_cast<off_t>(offset + done));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail("cannot read");
        if (got == 0) throw StoreError(path_.string() + " is shorter than it should be");
        done += static_cast<std::size_t>(got);
    }
    return bytes;
}

FileIdentity identity_of(const fs::path& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) return std::nullopt;
    return std::pair(std::uint64_t{status.st_dev}, std::uint64_t{status.st_ino});
}

void sync_folder(const fs::path& folder) {
    File(folder, O_RDONLY | O_DIRECTORY).sync();
}

void write_durably(const fs::path& path, std::string_view bytes) {
    static std::atomic<unsigned> number{0};
    const fs::path beside = path.parent_path() /
                            (".new-" + std::to_string(::getpid()) + "-" + std::to_string(number++));
    try {
        const File file(beside, O_WRONLY | O_CREAT | O_EXCL);
        file.write(bytes);
        file.sync();
        if (::rename(beside.c_str(), path.c_str()) != 0) {
            throw StoreError("cannot name " + path.string() + ": " + std::strerror(errno));
        }
    } catch (...) {
        ::unlink(beside.c_str());
        throw;
    }
    sync_folder(path.parent_path());
}

}  // namespace lastflat::server
