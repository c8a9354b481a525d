// Bodies as JSON values, for bodies that contain them. For the files of this folder alone.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "core/numerics/types.h"

namespace lastflat {
struct Plan;
struct Repair;
struct Warning;
}  // namespace lastflat

namespace lastflat::api {

struct Job;
struct Problem;
enum class JobState;

using Json = nlohmann::ordered_json;

/// Broken UTF-8 is replaced: what stands in a text may come from a model.
[[nodiscard]] inline std::string text_of(const Json& document, int indent = -1) {
    return document.dump(indent, ' ', false, Json::error_handler_t::replace);
}

[[nodiscard]] inline Json json_of(const Vec2& p) {
    return {p.x(), p.y()};
}
[[nodiscard]] inline Json json_of(const Vec3& p) {
    return {p.x(), p.y(), p.z()};
}
[[nodiscard]] Json json_of(const Job& job);
/// How many jobs are in each state, by its word.
[[nodiscard]] Json counts_json(const std::map<JobState, std::size_t>& states);
[[nodiscard]] Json json_of(const Problem& problem);
[[nodiscard]] Json json_of(const lastflat::Repair& repair);
[[nodiscard]] Json json_of(const lastflat::Warning& warning);
/// What was found on a bare last, with the whole `request` that was run.
[[nodiscard]] Json json_of(const lastflat::Plan& plan);

template <class Item>
[[nodiscard]] Json json_of(const std::vector<Item>& items) {
    Json list = Json::array();
    for (const Item& item : items) list.push_back(json_of(item));
    return list;
}

/// {"items": [...]}.
template <class Item>
[[nodiscard]] std::string list_of(const std::vector<Item>& items) {
    return text_of(Json{{"items", json_of(items)}});
}

}  // namespace lastflat::api
