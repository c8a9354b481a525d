// Which route a method and a path lead to.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/http/http.h"

namespace lastflat::http {

struct RouteMatch {
    const Route* route = nullptr;  ///< null: no route of this method has the path
    std::vector<std::string> captures;
};

class RouteTable {
public:
    /// Throws: std::invalid_argument if a route has no handler, takes a body although its method
    ///         or its being express forbids it, names a method that cannot be served, or has a
    ///         pattern that would need percent-encoding.
    explicit RouteTable(std::vector<Route> routes);

    /// `path` is compared as it was sent: an encoded path is never a second name for a route. HEAD
    /// finds GET's route.
    [[nodiscard]] RouteMatch find(std::string_view method, std::string_view path) const;

    /// Whether a route of the method would have the path, but for an id in it that is none.
    [[nodiscard]] bool has_malformed_id(std::string_view method, std::string_view path) const;

    /// The methods of the path as an Allow header; empty if no route has the path.
    [[nodiscard]] std::string allowed(std::string_view path) const;

private:
    std::vector<Route> routes_;
};

/// What answers OPTIONS: 204 with an Allow header, the request's one capture.
[[nodiscard]] const Route& options_route();

}  // namespace lastflat::http
