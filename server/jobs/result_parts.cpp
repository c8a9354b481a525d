#include "server/jobs/result_parts.h"

#include <nlohmann/json.hpp>

#include "server/support/crypto.h"

namespace lastflat::server {

std::string to_json(const std::vector<ResultPart>& parts) {
    nlohmann::json json = nlohmann::json::array();
    for (const ResultPart& part : parts) {
        json.push_back({{"format", part.format},
                        {"offset", part.offset},
                        {"size", part.size},
                        {"digest", part.digest}});
    }
    return json.dump();
}

std::uint64_t size_of(const std::vector<ResultPart>& parts) {
    std::uint64_t size = 0;
    for (const ResultPart& part : parts) size += part.size;
    return size;
}

std::vector<ResultPart> result_parts_of(std::string_view text) {
    std::vector<ResultPart> parts;
    if (text.empty()) return parts;
    for (const auto& part : nlohmann::json::parse(text)) {
        if (part.value("gzip", false)) continue;  // of a result of before: compressed a second time
        parts.push_back({part.at("format"), part.at("offset"), part.at("size"), part.at("digest")});
    }
    return parts;
}

const ResultPart& result_part(const JobRecord& job, std::string_view format) {
    for (const ResultPart& part : job.parts) {
        if (part.format == format) return part;
    }
    throw CorruptBlob("the result of " + job.id + " has no part " + std::string(format));
}

std::string result_bytes(const BlobStore& blobs, const JobRecord& job, const ResultPart& part) {
    std::string bytes = blobs.read(job.result, part.offset, part.size);
    if (sha256(bytes) != part.digest)
        throw CorruptBlob("the result of " + job.id + " has other bytes");
    return bytes;
}

}  // namespace lastflat::server
