#include "server/support/gzip.h"

#include <libdeflate.h>

#include <memory>
#include <new>
#include <stdexcept>

namespace lastflat::server {
namespace {

/// Fast: a higher level costs several times the time and saves a tenth of the bytes.
constexpr int compression_level = 1;

}  // namespace

std::string gzip(std::string_view bytes) {
    const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
        libdeflate_alloc_compressor(compression_level), &libdeflate_free_compressor);
    if (!compressor) throw std::bad_alloc();
    std::string packed(libdeflate_gzip_compress_bound(compressor.get(), bytes.size()), '\0');
    packed.resize(libdeflate_gzip_compress(compressor.get(), bytes.data(), bytes.size(),
                                           packed.data(), packed.size()));
    if (packed.empty()) throw std::runtime_error("compression failed");
    return packed;
}

}  // namespace lastflat::server
