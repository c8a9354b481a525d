// Models and results, each kept under the SHA-256 of its bytes: what is the same is kept once.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <shared_mutex>
#include <string>
#include <string_view>
#include <vector>

#include "api/refusal.h"
#include "server/support/fair_gate.h"

namespace lastflat::server {

/// A blob whose bytes are not those that were kept.
class CorruptBlob : public api::Refusal {
public:
    explicit CorruptBlob(const std::string& why)
        : Refusal({"result_corrupt",
                   "the stored bytes have changed on the disk; post the job again, with "
                   "Cache-Control: no-cache"},
                  why) {}
};

/// Every call is safe from any thread and may throw StoreError.
class BlobStore {
public:
    virtual ~BlobStore() = default;

    /// While somebody holds one, nothing is removed: from `put` until the blob's name is in a row.
    [[nodiscard]] std::shared_lock<FairGate> pin() const { return std::shared_lock(removal_); }

    /// Blobs that nobody removes while it lives, for those who cannot pin so long.
    class Holds {
    public:
        explicit Holds(const BlobStore& blobs) : blobs_(blobs) {}
        ~Holds() { clear(); }
        Holds(const Holds&) = delete;
        Holds& operator=(const Holds&) = delete;
        /// While pinned.
        void add(const std::string& digest) {
            const std::scoped_lock lock(blobs_.holding_);
            if (digests_.insert(digest).second) ++blobs_.held_[digest];
        }
        [[nodiscard]] bool has(const std::string& digest) const {
            return digests_.contains(digest);
        }
        /// What was held.
        std::vector<std::string> clear() {
            const std::scoped_lock lock(blobs_.holding_);
            for (const std::string& digest : digests_) {
                if (--blobs_.held_[digest] == 0) blobs_.held_.erase(digest);
            }
            std::vector<std::string> digests(digests_.begin(), digests_.end());
            digests_.clear();
            return digests;
        }

    private:
        const BlobStore& blobs_;
        std::set<std::string> digests_;
    };

    /// Keeps the bytes and returns their digest; they are on the disk then. They are written even
    /// if they are there already, unless `is_own` says that whoever sends them has them here: the
    /// time that it takes tells nobody what others have.
    using IsOwn = std::function<bool(const std::string& digest)>;
    virtual std::string put(std::string_view bytes, const IsOwn& is_own = {}) const = 0;
    /// Takes over a file that is already on the disk (same file system), under its digest. May be
    /// repeated after it failed. Throws: StoreError, also if there is neither file nor blob.
    virtual void adopt(const std::filesystem::path& file, const std::string& digest) const = 0;
    /// Where the blob is, or would be.
    [[nodiscard]] virtual std::filesystem::path path_of(const std::string& digest) const = 0;
    /// Throws: StoreError, CorruptBlob.
    [[nodiscard]] virtual std::string read(const std::string& digest) const = 0;
    [[nodiscard]] virtual std::string read(const std::string& digest, std::size_t offset,
                                           std::size_t size) const = 0;

    /// Removes those of the blobs that nobody needs: `is_needed` is asked while nothing can be
    /// pinned. Returns how many there were.
    template <class IsNeeded>
    std::size_t remove_unneeded(const std::vector<std::string>& digests, IsNeeded is_needed) const {
        const std::unique_lock lock(removal_);
        std::size_t removed = 0;
        for (const std::string& digest : digests) {
            if (!is_held(digest) && !is_needed(digest) && remove(digest)) ++removed;
        }
        return removed;
    }
    [[nodiscard]] virtual std::vector<std::string> all() const = 0;
    [[nodiscard]] virtual std::uintmax_t bytes() const = 0;
    /// Of the disk that the blobs are on.
    [[nodiscard]] virtual std::uintmax_t free_bytes() const = 0;

private:
    virtual bool remove(const std::string& digest) const = 0;
    [[nodiscard]] bool is_held(const std::string& digest) const {
        const std::scoped_lock lock(holding_);
        return held_.contains(digest);
    }

    mutable FairGate removal_;
    mutable std::mutex holding_;
    mutable std::map<std::string, int> held_;
};

}  // namespace lastflat::server
