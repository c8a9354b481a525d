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
    const auto add = [&](const char* format, std::string_view bytes) {
        pack.parts.push_back({format, offset, bytes.size(), sha256(bytes)});
        whole.add(bytes);
        file.write(bytes);
        offset += bytes.size();
    };
    add("json", output.json);
    add("svg", output.svg);
    add("glb", output.glb);
    add("obj", output.obj);
    add("metrics", output.metrics);
    file.sync();
    pack.result = whole.finish();
    return pack;
}

}  // namespace lastflat::server
