// openapi.json, for tests that hold the code against it.
#pragma once

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "api/words.h"

namespace lastflat::api::test {

inline const nlohmann::json& schema(const std::string& name) {
    static const nlohmann::json contract = nlohmann::json::parse(
        std::ifstream(std::string(std::getenv("LASTFLAT_SOURCE")) + "/api/openapi.json"));
    return contract.at("components").at("schemas").at(name);
}

template <class Value, std::size_t size>
std::set<std::string> words(const Word<Value> (&table)[size]) {
    std::set<std::string> words;
    for (const auto& line : table) words.emplace(line.word);
    return words;
}

}  // namespace lastflat::api::test
