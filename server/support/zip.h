// A ZIP archive, entry by entry, of texts that are compressed already.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace lastflat::server {

/// What is returned, one after the other, is the archive; nothing of it is kept but its directory.
class Zip {
public:
    /// An archive without the extensions for more has so many bytes and entries.
    static constexpr std::uint64_t most_bytes = 0xffff'fffe;
    static constexpr std::size_t most_entries = 0xfffe;

    /// The next entry. `name`: ASCII, a relative path; `gzip`: its bytes as `gzip` packed them.
    /// Throws: std::length_error if the archive would be too large; std::invalid_argument if the
    /// bytes are no gzip of that kind.
    [[nodiscard]] std::string entry(const std::string& name, std::string_view gzip);
    /// What comes after the last entry.
    [[nodiscard]] std::string end() const;

private:
    std::string directory_;
    std::uint64_t bytes_ = 0;
    std::size_t entries_ = 0;
};

}  // namespace lastflat::server
