// The documents that the service hands out about itself.
#pragma once

namespace lastflat::server {

extern const char* const openapi_json;  ///< api/openapi.json
extern const char* const docs_html;
extern const char* const docs_css;
extern const char* const docs_js;

}  // namespace lastflat::server
