#include "api/asset.h"

#include "api/json.h"
#include "api/timestamp.h"

namespace lastflat::api {

static Json json_of(const Asset& asset) {
    return {
        {"id", asset.digest}, {"bytes", asset.bytes}, {"created_at", rfc3339(asset.created_ms)}};
}

std::string to_json(const Asset& asset) {
    return text_of(json_of(asset));
}

std::string to_json(const std::vector<Asset>& assets) {
    return list_of(assets);
}

}  // namespace lastflat::api
