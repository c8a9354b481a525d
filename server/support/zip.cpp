// Based on: PKWARE, .ZIP File Format Specification 6.3.3; RFC 1952. No library writes entries that
// are deflated already, and results are: they are sent as they are kept.
#include "server/support/zip.h"

#include <stdexcept>

namespace lastflat::server {
namespace {

constexpr std::size_t gzip_head = 10, gzip_tail = 8;
constexpr std::uint16_t version = 20, deflated = 8;
/// 1 January 1980, midnight: the same results make the same archive.
constexpr std::uint32_t dos_time = 0x0021'0000;

std::string little(std::uint64_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i) & 0xffU);
    return text;
}

}  // namespace

std::string Zip::entry(const std::string& name, std::string_view gzip) {
    constexpr std::string_view magic("\x1f\x8b\x08\0", 4);
    if (gzip.size() < gzip_head + gzip_tail || !gzip.starts_with(magic))
        throw std::invalid_argument(name + " is not packed as results are");
    const std::string_view tail = gzip.substr(gzip.size() - gzip_tail);
    const std::string_view data = gzip.substr(gzip_head, gzip.size() - gzip_head - gzip_tail);
    // Flags, method, time; then what gzip has at its end (CRC-32, size) around the packed size.
    const std::string common = little(0, 2) + little(deflated, 2) + little(dos_time, 4) +
                               std::string(tail.substr(0, 4)) + little(data.size(), 4) +
                               std::string(tail.substr(4)) + little(name.size(), 2) + little(0, 2);
    directory_ += little(0x0201'4b50, 4) + little(version, 2) + little(version, 2) + common +
                  little(0, 2) + little(0, 2) + little(0, 2) + little(0, 4) + little(bytes_, 4) +
                  name;
    std::string entry = little(0x0403'4b50, 4) + little(version, 2) + common + name;
    entry += data;
    bytes_ += entry.size();
    if (bytes_ + directory_.size() > most_bytes || ++entries_ > most_entries)
        throw std::length_error("the archive is too large");
    return entry;
}

std::string Zip::end() const {
    return directory_ + little(0x0605'4b50, 4) + little(0, 2) + little(0, 2) + little(entries_, 2) +
           little(entries_, 2) + little(directory_.size(), 4) + little(bytes_, 4) + little(0, 2);
}

}  // namespace lastflat::server
