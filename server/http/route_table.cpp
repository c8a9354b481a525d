#include "server/http/route_table.h"

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>

namespace lastflat::http {
namespace {

bool all_of(std::string_view text, std::string_view allowed) {
    return text.find_first_not_of(allowed) == std::string_view::npos;
}

/// No path that they match needs percent-encoding.
constexpr std::string_view pattern_characters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._:/{}";

/// A ULID, or a UUID as RFC 9562 writes it.
bool is_id(std::string_view text) {
    constexpr std::string_view hexadecimal = "0123456789abcdef";
    if (text.size() == 26) return all_of(text, "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ");
    if (text.size() != 36) return false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool dash = i == 8 || i == 13 || i == 18 || i == 23;
        if (dash ? text[i] != '-' : hexadecimal.find(text[i]) == std::string_view::npos)
            return false;
    }
    return true;
}

enum class Ids { good, any };

/// What of the path's beginning the group takes; empty: it does not fit.
std::string_view match_of(std::string_view group, std::string_view path, Ids ids) {
    if (ids == Ids::any) return path.substr(0, path.find('/'));
    if (group == "{id}") {
        for (const std::size_t length : {36u, 26u}) {
            if (is_id(path.substr(0, length))) return path.substr(0, length);
        }
    }
    const std::string_view digest = path.substr(0, 64);
    const bool fits = digest.size() == 64 && all_of(digest, "0123456789abcdef");
    return group == "{digest}" && fits ? digest : std::string_view();
}

/// What the pattern's groups matched; nothing if the path is another one.
std::optional<std::vector<std::string>> captures_of(std::string_view pattern, std::string_view path,
                                                    Ids ids = Ids::good) {
    std::vector<std::string> captures;
    while (!pattern.empty()) {
        const std::size_t group = std::min(pattern.find('{'), pattern.size());
        if (path.substr(0, group) != pattern.substr(0, group)) return std::nullopt;
        path.remove_prefix(group);
        pattern.remove_prefix(group);
        if (pattern.empty()) break;
        const std::string_view name = pattern.substr(0, pattern.find('}') + 1);
        const std::string_view value = match_of(name, path, ids);
        if (value.empty()) return std::nullopt;
        captures.emplace_back(value);
        path.remove_prefix(value.size());
        pattern.remove_prefix(name.size());
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
        if (route.pattern.substr(0, 1) != "/" || !all_of(route.pattern, pattern_characters)) {
            throw std::invalid_argument(name + ": this pattern would need percent-encoding");
        }
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

bool RouteTable::has_malformed_id(std::string_view method, std::string_view path) const {
    const std::string_view wanted = method == "HEAD" ? "GET" : method;
    return std::any_of(routes_.begin(), routes_.end(), [&](const Route& route) {
        return (route.method == wanted || wanted == "OPTIONS") &&
               captures_of(route.pattern, path, Ids::any).has_value();
    });
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

const Route& options_route() {
    static const Route route{"OPTIONS", "*", [](const Request& request) {
                                 Response response;
                                 response.status = 204;
                                 response.headers.emplace_back("Allow", request.captures.at(0));
                                 return response;
                             }};
    return route;
}

}  // namespace lastflat::http
