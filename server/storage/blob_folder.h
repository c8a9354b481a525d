// Blobs as files of a folder, named by their digests.
#pragma once

#include "server/jobs/blob_store.h"
#include "server/support/files.h"

namespace lastflat::server {

class BlobFolder final : public BlobStore {
public:
    /// Makes the folder if it is missing; clears what a write that was cut off left behind. One
    /// process at a time. Throws: StoreError.
    explicit BlobFolder(std::filesystem::path folder);
    /// Only to look at blobs that another process may be using.
    struct Looking {};
    BlobFolder(Looking, std::filesystem::path folder) : folder_(std::move(folder)) {}

    std::string put(std::string_view bytes, const IsOwn& is_own = {}) const override;
    void adopt(const std::filesystem::path& file, const std::string& digest) const override;
    [[nodiscard]] std::filesystem::path path_of(const std::string& digest) const override;
    [[nodiscard]] std::string read(const std::string& digest) const override;
    [[nodiscard]] std::string read(const std::string& digest, std::size_t offset,
                                   std::size_t size) const override;
    [[nodiscard]] std::vector<std::string> all() const override;
    [[nodiscard]] std::uintmax_t bytes() const override;
    [[nodiscard]] std::uintmax_t free_bytes() const override;
    /// Writes and reads. Throws: StoreError if either cannot be done.
    void check() const;

private:
    void remove_unfinished() const;
    bool remove(const std::string& digest) const override;
    /// Throws: CorruptBlob if it is gone; StoreError.
    [[nodiscard]] File open(const std::string& digest) const;
    [[nodiscard]] bool holds(const std::filesystem::path& path, std::string_view bytes) const;

    const std::filesystem::path folder_;
};

}  // namespace lastflat::server
