#include "server/protocol/result_pack.h"

#include <fcntl.h>

#include "server/support/crypto.h"
#include "server/support/files.h"

namespace lastflat::server {

Succeeded write_result_pack(const JobOutput& output, const std::filesystem::path& path) {
    const File file(path, O_WRONLY | O_CREAT | O_TRUNC);
    Succeeded pack;
    Sha256 whole;
    std::uint64_t offset = 0;
    const auto add = [&](const char* format, bool is_gzip, std::string_view bytes) {
        pack.parts.push_back({format, is_gzip, offset, bytes.size(), sha256(bytes)});
        whole.add(bytes);
        file.write(bytes);
        offset += bytes.size();
    };
    const auto add_both = [&](const char* format, const Rendered& rendered) {
        add(format, false, rendered.bytes);
        add(format, true, rendered.gzip);
    };
    add_both("json", output.json);
    add_both("svg", output.svg);
    add_both("glb", output.glb);
    add_both("obj", output.obj);
    add_both("metrics", output.metrics);
    file.sync();
    pack.result = whole.finish();
    return pack;
}

}  // namespace lastflat::server
