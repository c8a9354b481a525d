// Files that are on the disk when a call returns.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "api/refusal.h"
#include "server/support/descriptor.h"

namespace lastflat::server {

/// The store cannot do its work now (a full or broken disk, a locked database). What was asked for
/// did not happen; it may be asked for again.
class StoreError : public api::Refusal {
public:
    explicit StoreError(const std::string& why)
        : Refusal({"store_unavailable",
                   "the service cannot store or read its data now (a full or broken disk?); "
                   "nothing was changed, try again later"},
                  why) {}
};

/// An open file that knows its path, for those who have to be told what went wrong with it.
class File {
public:
    /// Throws: StoreError naming the path.
    File(const std::filesystem::path& path, int flags, int mode = 0600);

    [[nodiscard]] int fd() const { return descriptor_.fd(); }
    void write(std::string_view bytes) const;
    /// Until the disk has it.
    void sync() const;
    [[nodiscard]] std::size_t size() const;
    /// Exactly `size` bytes. Throws: StoreError if there are fewer.
    [[nodiscard]] std::string read(std::size_t offset, std::size_t size) const;

private:
    [[noreturn]] void fail(const char* what) const;
    const std::filesystem::path path_;
    const Descriptor descriptor_;
};

/// Which file a name stands for: device and inode; nothing: there is none.
using FileIdentity = std::optional<std::pair<std::uint64_t, std::uint64_t>>;
[[nodiscard]] FileIdentity identity_of(const std::filesystem::path& path);

/// Makes a rename, a new name or a removal in the folder last.
void sync_folder(const std::filesystem::path& folder);

/// The file has these bytes or is not there, whatever happens meanwhile.
void write_durably(const std::filesystem::path& path, std::string_view bytes);

}  // namespace lastflat::server
