// Why a request is not handed to its handler, said so that the caller can mend it.
#pragma once

#include <exception>
#include <string>
#include <string_view>

#include "api/refusal.h"
#include "server/http/http.h"

namespace lastflat::http {

/// A head that is not served: what is known of who sent it.
class RefusedHead : public api::Refusal {
public:
    /// `origin`: the web page that asks. The answer to a HEAD request has no body, also when it is
    /// a refusal.
    RefusedHead(const api::Refusal& why, std::string_view origin, bool without_body)
        : api::Refusal(why), origin_(origin), without_body_(without_body) {}
    [[nodiscard]] const std::string& origin() const { return origin_; }
    [[nodiscard]] bool is_without_body() const { return without_body_; }

private:
    std::string origin_;
    bool without_body_;
};

/// 503: there is more to do than can be taken.
[[nodiscard]] api::Refusal overloaded();

/// 429: the client has more requests waiting than one client may.
[[nodiscard]] api::Refusal client_busy();

/// What `problem` makes of it. Never throws: a problem maker that does gets a bare 500.
[[nodiscard]] Response answer_to(const Request& request, const std::exception_ptr& thrown,
                                 const ProblemMaker& problem) noexcept;

}  // namespace lastflat::http
