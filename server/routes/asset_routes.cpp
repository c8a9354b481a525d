#include "server/routes/asset_routes.h"

#include "api/base64.h"
#include "api/refusal.h"
#include "api/submission.h"
#include "server/jobs/job_control.h"
#include "server/jobs/job_intake.h"
#include "server/routes/answers.h"
#include "server/support/crypto.h"

namespace lastflat::server {
namespace {

using http::Request;
using http::Response;

Response asset_response(int status, const Asset& asset) {
    Response response = json_response(status, to_json(asset));
    response.headers.emplace_back("ETag", "\"" + asset.digest + "\"");
    return response;
}

/// `Content-Digest: sha-256=:BASE64:` (RFC 9530) has to be that of the body.
void check_digest(const Request& request, std::string_view bytes) {
    constexpr std::string_view algorithm = "sha-256=:";
    const std::string_view header = request.header("content-digest");
    const std::size_t begin = header.find(algorithm);
    if (header.empty()) return;
    const std::size_t end =
        begin == std::string_view::npos ? begin : header.find(':', begin + algorithm.size());
    const auto digest = end == std::string_view::npos
                            ? std::nullopt
                            : api::decode_base64(header.substr(begin + algorithm.size(),
                                                               end - begin - algorithm.size()));
    if (!digest) api::refuse("header_invalid", "Content-Digest is not sha-256=:BASE64: (RFC 9530)");
    if (hexadecimal(*digest) != sha256(bytes))
        api::refuse("digest_differs", "the body is not the one of Content-Digest; send it again");
}

[[noreturn]] void refuse_unknown(const std::string& id) {
    api::refuse("asset_not_found", "there is no asset " + id + "; it may have been deleted");
}

Response list_assets(const AssetServices& service, const Request& request) {
    return json_response(200, api::to_json(service.assets.list(request.principal)));
}

Response add_asset(const AssetServices& service, const Request& request) {
    const http::BodyPart* model = nullptr;
    for (const http::BodyPart& part : request.body) {
        if (part.name.empty() || part.name == "model") model = &part;
    }
    if (model == nullptr || model->bytes.empty())
        api::refuse("model_missing", "the model is empty: send it as the body or the part 'model'");
    check_digest(request, model->bytes);
    api::check_model_bytes(model->bytes);
    check_room(service.blobs, service.min_free_mb);
    AssetLimits limits;
    limits.bytes = service.assets_per_key_mb << 20;
    limits.bytes_of_owner = service.storage_per_key_mb << 20;
    std::string digest;
    AssetAdmission admission{};
    {
        const auto pin = service.blobs.pin();
        digest = service.blobs.put(model->bytes, [&](const std::string& own) {
            return service.jobs.has_blob(request.principal, own);
        });
        admission = service.assets.add(request.principal, digest, model->bytes.size(), limits);
    }
    const bool is_kept = admission == AssetAdmission::added || admission == AssetAdmission::known;
    if (!is_kept) drop_unneeded(service.blobs, service.jobs, {digest});
    if (admission == AssetAdmission::storage_full) refuse_storage(limits.bytes_of_owner);
    if (admission == AssetAdmission::full) {
        api::refuse("assets_full",
                    "with this asset there would be more than " +
                        std::to_string(service.assets_per_key_mb) + " MiB or " +
                        std::to_string(limits.count) +
                        " assets of this API key (the limit --assets-per-key-mb); delete some: "
                        "GET /v1/assets lists them");
    }
    const auto asset = service.assets.find(request.principal, digest);
    if (!asset) refuse_unknown(digest);  // deleted meanwhile
    Response response = asset_response(admission == AssetAdmission::added ? 201 : 200, *asset);
    response.headers.emplace_back("Location", "/v1/assets/" + digest);
    return response;
}

Response get_asset(const AssetServices& service, const Request& request) {
    const std::string& id = request.captures.at(0);
    const auto asset = service.assets.find(request.principal, id);
    if (!asset) refuse_unknown(id);
    return asset_response(200, *asset);
}

Response remove_asset(const AssetServices& service, const Request& request) {
    const std::string& id = request.captures.at(0);
    if (!service.assets.remove(request.principal, id)) refuse_unknown(id);
    drop_unneeded(service.blobs, service.jobs, {id});
    return empty_response(204);
}

}  // namespace

std::vector<http::Route> asset_routes(const AssetServices& service) {
    const auto route = [&](const char* method, const char* pattern,
                           Response (*handle)(const AssetServices&, const Request&),
                           bool takes_body = false) {
        return http::Route{
            method, pattern,
            [service, handle](const Request& request) { return handle(service, request); },
            takes_body};
    };
    return {route("POST", "/v1/assets", add_asset, true), route("GET", "/v1/assets", list_assets),
            route("GET", "/v1/assets/{digest}", get_asset),
            route("DELETE", "/v1/assets/{digest}", remove_asset)};
}

}  // namespace lastflat::server
