#include "server/worker/result_pack.h"

#include <fcntl.h>
#include <zlib.h>

#include <array>
#include <future>
#include <stdexcept>

#include "server/crypto.h"
#include "server/stores/files.h"

namespace lastflat::server {
namespace {

/// Fast: a higher level costs several times the time and saves a tenth of the bytes.
constexpr int compression_level = 1;
constexpr int gzip_window = 15 + 16;
constexpr std::size_t write_step = 4u << 20;

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
        const std::size_t given = std::min(left, write_step);
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

ResultPack write_result_pack(const JobOutput& output, const std::filesystem::path& path) {
    const std::array<std::pair<const char*, const std::string*>, 5> formats{
        {{"json", &output.json},
         {"svg", &output.svg},
         {"glb", &output.glb},
         {"obj", &output.obj},
         {"metrics", &output.metrics}}};
    std::array<std::future<std::string>, 5> compressed;
    for (std::size_t i = 0; i < formats.size(); ++i) {
        compressed[i] = std::async(std::launch::async, [&, i] { return gzip(*formats[i].second); });
    }
    const File file(path, O_WRONLY | O_CREAT | O_TRUNC);
    ResultPack pack;
    Sha256 whole;
    std::uint64_t offset = 0;
    const auto add = [&](const char* format, bool is_gzip, std::string_view bytes) {
        pack.parts.push_back({format, is_gzip, offset, bytes.size(), sha256(bytes)});
        whole.add(bytes);
        file.write(bytes);
        offset += bytes.size();
    };
    for (std::size_t i = 0; i < formats.size(); ++i) {
        add(formats[i].first, false, *formats[i].second);
        add(formats[i].first, true, compressed[i].get());
    }
    file.sync();
    pack.digest = whole.finish();
    return pack;
}

}  // namespace lastflat::server
