#include "server/storage/blob_folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <mutex>

#include "server/support/crypto.h"
#include "server/support/files.h"

namespace lastflat::server {

namespace fs = std::filesystem;

BlobFolder::BlobFolder(fs::path folder) : folder_(std::move(folder)) {
    std::error_code error;
    bool made = false;
    // All of them at once, so that no later write has to make one and sync two folders.
    for (int i = 0; i < 256; ++i) {
        made |= fs::create_directories(folder_ / hexadecimal(std::string(1, static_cast<char>(i))),
                                       error);
        if (error) throw StoreError("cannot make " + folder_.string() + ": " + error.message());
    }
    if (made) {
        sync_folder(folder_);
        sync_folder(folder_.parent_path());
    }
    remove_unfinished();
}

void BlobFolder::remove_unfinished() const {
    for (const auto& group : fs::directory_iterator(folder_)) {
        for (const auto& file : fs::directory_iterator(group)) {
            if (file.path().filename().string().front() == '.') ::unlink(file.path().c_str());
        }
    }
}

fs::path BlobFolder::path_of(const std::string& digest) const {
    return folder_ / digest.substr(0, 2) / digest.substr(2);
}

bool BlobFolder::holds(const fs::path& path, std::string_view bytes) const {
    std::error_code error;
    if (fs::file_size(path, error) != bytes.size() || error) return false;
    constexpr std::size_t step = 1u << 20;  // a blob may be as large as everything else in memory
    const File file(path, O_RDONLY);
    for (std::size_t at = 0; at < bytes.size(); at += step) {
        const std::string_view piece = bytes.substr(at, step);
        if (file.read(at, piece.size()) != piece) return false;
    }
    return true;
}

std::string BlobFolder::put(std::string_view bytes, const IsOwn& is_own) const {
    std::string digest = sha256(bytes);
    const fs::path path = path_of(digest);
    // Compared, not believed: a blob that went bad on the disk is mended here. One that is there
    // may have got its name a moment ago, by somebody who has not made it last yet.
    if (is_own && is_own(digest) && holds(path, bytes))
        sync_folder(path.parent_path());
    else
        write_durably(path, bytes);
    return digest;
}

void BlobFolder::adopt(const fs::path& file, const std::string& digest) const {
    const fs::path path = path_of(digest);
    std::error_code unknown;
    const bool taken_before = !fs::exists(file, unknown) && fs::exists(path, unknown);
    if (!taken_before && ::rename(file.c_str(), path.c_str()) != 0) {
        throw StoreError("cannot name " + path.string() + ": " + std::strerror(errno));
    }
    sync_folder(path.parent_path());
}

File BlobFolder::open(const std::string& digest) const {
    if (!identity_of(path_of(digest))) throw CorruptBlob("the blob " + digest + " is gone");
    return File(path_of(digest), O_RDONLY);
}

std::string BlobFolder::read(const std::string& digest) const {
    const File file = open(digest);
    std::string bytes = file.read(0, file.size());
    if (sha256(bytes) != digest) throw CorruptBlob("the blob " + digest + " has other bytes");
    return bytes;
}

std::string BlobFolder::read(const std::string& digest, std::size_t offset,
                             std::size_t size) const {
    const File file = open(digest);
    if (file.size() < offset + size) throw CorruptBlob("the blob " + digest + " is cut");
    return file.read(offset, size);
}

void BlobFolder::check() const {
    static std::atomic<unsigned> number{0};  // several may check at once
    const fs::path path = folder_ / "00" / (".check-" + std::to_string(number++));
    write_durably(path, "a check");
    (void)File(path, O_RDONLY).read(0, 7);
    ::unlink(path.c_str());
}

bool BlobFolder::remove(const std::string& digest) const {
    return ::unlink(path_of(digest).c_str()) == 0;
}

std::vector<std::string> BlobFolder::all() const {
    std::vector<std::string> digests;
    for (const auto& group : fs::directory_iterator(folder_)) {
        for (const auto& file : fs::directory_iterator(group)) {
            const std::string name = file.path().filename();
            if (name.size() == 62) digests.push_back(group.path().filename().string() + name);
        }
    }
    return digests;
}

std::uintmax_t BlobFolder::bytes() const {
    std::uintmax_t sum = 0;
    for (const std::string& digest : all()) {
        std::error_code gone;
        const auto size = fs::file_size(path_of(digest), gone);
        if (!gone) sum += size;
    }
    return sum;
}

std::uintmax_t BlobFolder::free_bytes() const {
    std::error_code unknown;
    const fs::space_info space = fs::space(folder_, unknown);
    if (unknown) throw StoreError("the room on the disk cannot be told: " + unknown.message());
    return space.available;
}

}  // namespace lastflat::server
