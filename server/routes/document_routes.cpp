#include "server/routes/document_routes.h"

#include <nlohmann/json.hpp>

#include "server/routes/answers.h"
#include "server/routes/documents.h"
#include "server/support/crypto.h"

namespace lastflat::server {
namespace {

using Json = nlohmann::ordered_json;

http::Route document(const char* path, const char* type, std::string text) {
    const auto body = std::make_shared<const std::string>(std::move(text));
    const std::string etag = "\"" + sha256(*body).substr(0, 32) + "\"";
    return {"GET", path, [=](const http::Request& request) {
                http::Response response;
                response.media_type = type;
                response.body = body;
                response.headers.emplace_back("Cache-Control", "no-cache");
                response.headers.emplace_back("Content-Security-Policy",
                                              "default-src 'self'; frame-ancestors 'none'");
                return tagged(request, etag, std::move(response));
            }};
}

/// The schema of the constraint JSON as a document of its own.
std::string constraint_schema() {
    const Json contract = Json::parse(openapi_json);
    const Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                      {"title", "The constraints of a flattening"},
                      {"$ref", "#/components/schemas/FlattenRequest"},
                      {"components", {{"schemas", contract.at("components").at("schemas")}}}};
    return schema.dump();
}

}  // namespace

std::vector<http::Route> document_routes() {
    return {document("/openapi.json", "application/json", openapi_json),
            document("/schemas/constraints.json", "application/schema+json", constraint_schema()),
            document("/docs", "text/html; charset=utf-8", docs_html),
            document("/docs/docs.css", "text/css", docs_css),
            document("/docs/docs.js", "text/javascript", docs_js)};
}

}  // namespace lastflat::server
