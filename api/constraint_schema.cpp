#include "api/constraint_schema.h"

#include "api/json.h"

namespace lastflat::api {

std::string constraint_schema(std::string_view contract) {
    return text_of(
        {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
         {"title", "The constraints of a flattening"},
         {"$ref", "#/components/schemas/FlattenRequest"},
         {"components", {{"schemas", Json::parse(contract).at("components").at("schemas")}}}});
}

}  // namespace lastflat::api
