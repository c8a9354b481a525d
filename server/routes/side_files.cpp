#include "server/routes/side_files.h"

#include <algorithm>

#include "api/base64.h"
#include "api/object_reader.h"
#include "server/http/text.h"
#include "server/routes/answers.h"
#include "server/support/large_body_turn.h"

namespace lastflat::server {
namespace {

constexpr int deepest_gltf = 64;
constexpr std::string_view data_scheme = "data:";

/// The part whose file name is the URI, plain or percent-encoded; a leading "./" does not count.
std::size_t part_for(std::string uri, const std::vector<const http::BodyPart*>& buffers) {
    uri = http::percent_decoded(uri, false).value_or(uri);
    if (uri.rfind("./", 0) == 0) uri.erase(0, 2);
    const auto found = std::find_if(buffers.begin(), buffers.end(),
                                    [&](const auto* part) { return part->file_name == uri; });
    if (found == buffers.end())
        api::refuse("buffer_missing",
                    "the glTF refers to '" + uri.substr(0, 80) +
                        "': send that file as a part 'buffers' with this file name");
    return static_cast<std::size_t>(found - buffers.begin());
}

}  // namespace

std::string with_buffers_inside(std::string_view gltf,
                                const std::vector<const http::BodyPart*>& buffers,
                                const std::string& owner) {
    if (gltf.find_first_not_of(" \t\r\n") == std::string::npos ||
        gltf[gltf.find_first_not_of(" \t\r\n")] != '{')
        api::refuse("part_unused", "only a glTF document (JSON) has buffers beside it");
    const LargeBodyTurn turn(owner, gltf.size());
    nlohmann::json document = api::parse_json(gltf, deepest_gltf);
    std::vector<bool> used(buffers.size(), false);
    if (document.contains("buffers") && document["buffers"].is_array()) {
        for (auto& buffer : document["buffers"]) {
            if (!buffer.is_object() || !buffer.contains("uri") || !buffer["uri"].is_string())
                continue;
            const auto uri = buffer["uri"].get<std::string>();
            if (uri.rfind(data_scheme, 0) == 0) continue;
            const std::size_t part = part_for(uri, buffers);
            used[part] = true;
            buffer["uri"] =
                "data:application/octet-stream;base64," + api::encode_base64(buffers[part]->bytes);
        }
    }
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        if (!used[i])
            api::refuse("part_unused", "no buffer of the glTF is called '" +
                                           buffers[i]->file_name.substr(0, 80) + "'");
    }
    return document.dump();
}

}  // namespace lastflat::server
