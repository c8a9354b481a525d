#include "server/routes/answers.h"

#include <algorithm>
#include <charconv>
#include <new>

#include "api/problem_of.h"
#include "server/support/log.h"

namespace lastflat::server {
namespace {

constexpr int longest_wait_s = 60;
constexpr std::size_t most_waiting_body = 16u << 20;

std::size_t body_bytes(const http::Request& request) {
    std::size_t bytes = 0;
    for (const http::BodyPart& part : request.body) bytes += part.bytes.size();
    return bytes;
}

std::string_view next_item(std::string_view& list) {
    const std::size_t end = std::min(list.find(','), list.size());
    std::string_view item = list.substr(0, end);
    list.remove_prefix(std::min(end + 1, list.size()));
    while (!item.empty() && item.front() == ' ') item.remove_prefix(1);
    while (!item.empty() && item.back() == ' ') item.remove_suffix(1);
    return item;
}

/// Tags are compared weakly (RFC 9110, 13.1.2).
std::string_view opaque(std::string_view tag) {
    return tag.substr(0, 2) == "W/" ? tag.substr(2) : tag;
}

/// The service's own memory, not a worker's.
bool is_out_of_memory(const std::exception_ptr& thrown) {
    try {
        std::rethrow_exception(thrown);
    } catch (const std::bad_alloc&) {
        return true;
    } catch (...) {
        return false;
    }
}

}  // namespace

http::Response json_response(int status, std::string body) {
    http::Response response;
    response.status = status;
    response.media_type = "application/json";
    response.body = std::make_shared<const std::string>(std::move(body));
    response.headers.emplace_back("Cache-Control", "no-store");
    return response;
}

http::Response empty_response(int status) {
    http::Response response;
    response.status = status;
    return response;
}

api::Refusal refusal_to(const http::Request& request, const std::exception_ptr& thrown) {
    api::Refusal refusal = api::refusal_of(thrown);
    const bool is_internal = refusal.problem().code == "internal_error" || is_out_of_memory(thrown);
    if (is_internal || refusal.problem().status >= 500)
        log_event(is_internal ? "request_failed" : "request_refused",
                  {{"request", request.id}, {"path", request.path}, {"why", refusal.what()}});
    if (!is_internal) return refusal;
    return {"internal_error", "The server failed to answer. The fault is not in the request."};
}

http::Response answer_to(const http::Request& request, const std::exception_ptr& thrown) {
    const api::Refusal refusal = refusal_to(request, thrown);
    const api::Problem& problem = refusal.problem();
    http::Response response = json_response(problem.status, api::to_json(problem));
    response.media_type = "application/problem+json";
    response.headers.insert(response.headers.end(), refusal.headers().begin(),
                            refusal.headers().end());
    if (problem.code == "not_finished" || problem.code == "key_in_flight")
        response.headers.emplace_back("Retry-After", "1");
    else if (problem.status == 503 && refusal.headers().empty())
        response.headers.emplace_back("Retry-After", "5");
    if (problem.status == 401) response.headers.emplace_back("WWW-Authenticate", "Bearer");
    return response;
}

bool has_already(const http::Request& request, const std::string& etag) {
    std::string_view list = request.header("if-none-match");
    while (!list.empty()) {
        const std::string_view tag = next_item(list);
        if (tag == "*" || opaque(tag) == opaque(etag)) return true;
    }
    return false;
}

http::Response tagged(const http::Request& request, const std::string& etag,
                      http::Response response) {
    if (has_already(request, etag)) {
        response.status = 304;
        response.body.reset();
    }
    response.headers.emplace_back("ETag", etag);
    return response;
}

std::optional<int> preferred_wait(const http::Request& request) {
    if (body_bytes(request) > most_waiting_body) return std::nullopt;
    std::string_view list = request.header("prefer");
    while (!list.empty()) {
        const std::string_view item = next_item(list);
        if (item.substr(0, 5) != "wait=") continue;
        int seconds = 0;
        const auto [end, error] =
            std::from_chars(item.data() + 5, item.data() + item.size(), seconds);
        if (error != std::errc() || end != item.data() + item.size() || seconds < 0) continue;
        return std::min(seconds, longest_wait_s);
    }
    return std::nullopt;
}

}  // namespace lastflat::server
