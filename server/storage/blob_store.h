// Models and results, each kept under the SHA-256 of its bytes: what is the same is kept once.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <shared_mutex>
#include <string>
#include <string_view>
#include <vector>

#include "server/support/files.h"

namespace lastflat::server {

/// A blob whose bytes are not those that were kept.
class CorruptBlob : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A lock that many may share, and that who wants it alone gets as soon as those who have it leave:
/// the standard's lets new ones in for ever.
class FairGate {
public:
    void lock_shared() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return !alone_ && waiting_ == 0; });
        ++sharing_;
    }
    void unlock_shared() {
        const std::scoped_lock lock(mutex_);
        if (--sharing_ == 0) changed_.notify_all();
    }
    void lock() {
        std::unique_lock lock(mutex_);
        ++waiting_;
        changed_.wait(lock, [&] { return !alone_ && sharing_ == 0; });
        --waiting_;
        alone_ = true;
    }
    void unlock() {
        const std::scoped_lock lock(mutex_);
        alone_ = false;
        changed_.notify_all();
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::size_t sharing_ = 0, waiting_ = 0;
    bool alone_ = false;
};

class BlobStore {
public:
    /// Makes the folder if it is missing; clears what a write that was cut off left behind. One
    /// process at a time. Throws: StoreError.
    explicit BlobStore(std::filesystem::path folder);
    /// Only to look at blobs that another process may be using.
    struct Looking {};
    BlobStore(Looking, std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// While somebody holds one, nothing is removed: from `put` until the blob's name is in a row.
    [[nodiscard]] std::shared_lock<FairGate> pin() const { return std::shared_lock(removal_); }

    /// Keeps the bytes and returns their digest; they are on the disk then. Throws: StoreError.
    std::string put(std::string_view bytes) const;
    /// Takes over a file that is already on the disk (same file system), under its digest. May be
    /// repeated after it failed. Throws: StoreError, also if there is neither file nor blob.
    void adopt(const std::filesystem::path& file, const std::string& digest) const;
    /// Where the blob is, or would be.
    [[nodiscard]] std::filesystem::path path_of(const std::string& digest) const;
    /// Throws: StoreError, CorruptBlob.
    [[nodiscard]] std::string read(const std::string& digest) const;
    [[nodiscard]] std::string read(const std::string& digest, std::size_t offset,
                                   std::size_t size) const;

    /// Removes those of the blobs that nobody needs: `is_needed` is asked while nothing can be
    /// pinned. Returns how many there were.
    template <class IsNeeded>
    std::size_t remove_unneeded(const std::vector<std::string>& digests, IsNeeded is_needed) const {
        const std::unique_lock lock(removal_);
        std::size_t removed = 0;
        for (const std::string& digest : digests) {
            if (!is_needed(digest) && remove(digest)) ++removed;
        }
        return removed;
    }
    [[nodiscard]] std::vector<std::string> all() const;
    [[nodiscard]] std::uintmax_t bytes() const;
    /// Of the disk that the blobs are on.
    [[nodiscard]] std::uintmax_t free_bytes() const;

private:
    void remove_unfinished() const;
    bool remove(const std::string& digest) const;
    [[nodiscard]] bool holds(const std::filesystem::path& path, std::string_view bytes) const;

    const std::filesystem::path folder_;
    mutable FairGate removal_;
};

}  // namespace lastflat::server
