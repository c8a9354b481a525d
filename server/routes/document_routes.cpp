#include "server/routes/document_routes.h"

#include "api/constraint_schema.h"
#include "server/routes/answers.h"
#include "server/routes/documents.h"
#include "server/support/crypto.h"

namespace lastflat::server {
namespace {

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

}  // namespace

std::vector<http::Route> document_routes() {
    return {document("/openapi.json", "application/json", openapi_json),
            document("/schemas/constraints.json", "application/schema+json",
                     api::constraint_schema(openapi_json)),
            document("/docs", "text/html; charset=utf-8", docs_html),
            document("/docs/docs.css", "text/css", docs_css),
            document("/docs/docs.js", "text/javascript", docs_js)};
}

}  // namespace lastflat::server
