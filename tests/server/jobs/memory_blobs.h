// Blobs in memory: what only uses a store of them need not wait for a disk.
#pragma once

#include <map>

#include "server/jobs/blob_store.h"
#include "server/support/crypto.h"

namespace lastflat::server::test {

class MemoryBlobs final : public BlobStore {
public:
    std::string put(std::string_view bytes, const IsOwn& = {}) const override {
        const std::string digest = sha256(bytes);
        blobs_[digest] = bytes;
        return digest;
    }
    void adopt(const std::filesystem::path& file, const std::string&) const override {
        throw std::logic_error("nobody adopts " + file.string());
    }
    [[nodiscard]] std::filesystem::path path_of(const std::string& digest) const override {
        return "/nowhere/" + digest;
    }
    [[nodiscard]] std::string read(const std::string& digest) const override {
        return blobs_.at(digest);
    }
    [[nodiscard]] std::string read(const std::string& digest, std::size_t offset,
                                   std::size_t size) const override {
        return blobs_.at(digest).substr(offset, size);
    }
    [[nodiscard]] std::vector<std::string> all() const override {
        std::vector<std::string> digests;
        for (const auto& [digest, bytes] : blobs_) digests.push_back(digest);
        return digests;
    }
    [[nodiscard]] std::uintmax_t bytes() const override {
        std::uintmax_t sum = 0;
        for (const auto& [digest, bytes] : blobs_) sum += bytes.size();
        return sum;
    }
    [[nodiscard]] std::uintmax_t free_bytes() const override { return 1u << 30; }

private:
    bool remove(const std::string& digest) const override { return blobs_.erase(digest) > 0; }

    mutable std::map<std::string, std::string> blobs_;
};

}  // namespace lastflat::server::test
