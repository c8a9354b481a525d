#include "server/jobs/result_parts.h"

#include <nlohmann/json.hpp>

namespace lastflat::server {

std::string to_json(const std::vector<ResultPart>& parts) {
    nlohmann::json json = nlohmann::json::array();
    for (const ResultPart& part : parts) {
        json.push_back({{"format", part.format},
                        {"gzip", part.gzip},
                        {"offset", part.offset},
                        {"size", part.size},
                        {"digest", part.digest}});
    }
    return json.dump();
}

std::vector<ResultPart> result_parts_of(std::string_view text) {
    std::vector<ResultPart> parts;
    if (text.empty()) return parts;
    for (const auto& part : nlohmann::json::parse(text)) {
        parts.push_back({part.at("format"), part.at("gzip"), part.at("offset"), part.at("size"),
                         part.at("digest")});
    }
    return parts;
}

}  // namespace lastflat::server
