// The contract, as the server gives it out.
#pragma once

namespace lastflat::server {

/// The bytes of api/openapi.json.
extern const char* const openapi_json;

}  // namespace lastflat::server
