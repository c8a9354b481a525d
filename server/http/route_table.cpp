#include "server/http/route_table.h"

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>

namespace lastflat::http {
namespace {

constexpr std::string_view id_group = "{id}";
constexpr std::size_t id_length = 26;

bool is_id(std::string_view text) {
    return text.size() == id_length && std::all_of(text.begin(), text.end(), [](char c) {
               return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z');
           });
}

/// What the pattern's groups matched; nothing if the path is another one.
std::optional<std::vector<std::string>> captures_of(std::string_view pattern,
                                                    std::string_view path) {
    std::vector<std::string> captures;
    while (!pattern.empty()) {
        const std::size_t group = pattern.find(id_group);
        const std::string_view literal = pattern.substr(0, group);
        if (path.substr(0, literal.size()) != literal) return std::nullopt;
        path.remove_prefix(literal.size());
        pattern.remove_prefix(literal.size());
        if (group == std::string_view::npos) break;
        const std::string_view id = path.substr(0, id_length);
        if (!is_id(id)) return std::nullopt;
        captures.emplace_back(id);
        path.remove_prefix(id_length);
        pattern.remove_prefix(id_group.size());
    }
    if (!path.empty()) return std::nullopt;
    return captures;
}

}  // namespace

RouteTable::RouteTable(std::vector<Route> routes) : routes_(std::move(routes)) {
    constexpr std::array<std::string_view, 6> methods = {"GET",   "POST",   "PUT",
                                                         "PATCH", "DELETE", "OPTIONS"};
    for (const Route& route : routes_) {
        const std::string name = route.method + " " + route.pattern;
        if (!route.handler) throw std::invalid_argument(name + ": no handler");
        if (std::find(methods.begin(), methods.end(), route.method) == methods.end()) {
            throw std::invalid_argument(name + ": this method cannot have a route");
        }
        const bool may_have_body =
            route.method == "POST" || route.method == "PUT" || route.method == "PATCH";
        if (route.takes_body && (!may_have_body || route.express)) {
            throw std::invalid_argument(name + ": this route cannot take a body");
        }
    }
}

RouteMatch RouteTable::find(std::string_view method, std::string_view path) const {
    const std::string_view wanted = method == "HEAD" ? "GET" : method;
    for (const Route& route : routes_) {
        if (route.method != wanted) continue;
        if (auto captures = captures_of(route.pattern, path)) return {&route, std::move(*captures)};
    }
    return {};
}

std::string RouteTable::allowed(std::string_view path) const {
    std::vector<std::string> methods;
    const auto add = [&](const std::string& method) {
        if (std::find(methods.begin(), methods.end(), method) == methods.end()) {
            methods.push_back(method);
        }
    };
    for (const Route& route : routes_) {
        if (!captures_of(route.pattern, path)) continue;
        add(route.method);
        if (route.method == "GET") add("HEAD");
    }
    if (methods.empty()) return {};
    add("OPTIONS");
    std::string list;
    for (const std::string& method : methods) list += (list.empty() ? "" : ", ") + method;
    return list;
}

}  // namespace lastflat::http
