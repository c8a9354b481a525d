#include "server/worker/gzip.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <new>
#include <stdexcept>

namespace lastflat::server {
namespace {

/// Fast: a higher level costs several times the time and saves a tenth of the bytes.
constexpr int compression_level = 1;
constexpr int gzip_window = 15 + 16;
constexpr std::size_t read_step = 4u << 20;

}  // namespace

std::string gzip(std::string_view bytes) {
    z_stream stream{};
    if (deflateInit2(&stream, compression_level, Z_DEFLATED, gzip_window, 8, Z_DEFAULT_STRATEGY) !=
        Z_OK) {
        throw std::bad_alloc();
    }
    std::string packed;
    std::array<char, 64u << 10> step;
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    std::size_t left = bytes.size();
    int status = Z_OK;
    while (status == Z_OK) {
        // Its counters have 32 bits, our results may be longer.
        const std::size_t given = std::min(left, read_step);
        stream.avail_in = static_cast<uInt>(given);
        stream.next_out = reinterpret_cast<Bytef*>(step.data());
        stream.avail_out = static_cast<uInt>(step.size());
        status = deflate(&stream, given == left ? Z_FINISH : Z_NO_FLUSH);
        left -= given - stream.avail_in;
        packed.append(step.data(), step.size() - stream.avail_out);
    }
    deflateEnd(&stream);
    if (status != Z_STREAM_END) throw std::runtime_error("compression failed");
    return packed;
}

}  // namespace lastflat::server
