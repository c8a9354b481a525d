#include "server/routes/job_list.h"

#include <charconv>

#include "api/base64.h"
#include "api/refusal.h"
#include "api/timestamp.h"
#include "server/http/text.h"
#include "server/routes/answers.h"
#include "server/support/crypto.h"

namespace lastflat::server {
namespace {

using http::Request;
using http::Response;

constexpr std::size_t most_listed = 200;
constexpr std::size_t code_bytes = 12;  ///< of a cursor's signature

/// Positions in a list are the store's own; a signature keeps them from being made up, or used by
/// another key.
std::string cursor_code(const std::string& secret, const std::string& owner,
                        std::string_view position) {
    return hmac_sha256(secret, owner + "\n" + std::string(position)).substr(0, code_bytes);
}

std::string cursor_of(const std::string& secret, const std::string& owner, std::int64_t position) {
    const std::string text = std::to_string(position);
    return api::encode_base64url(cursor_code(secret, owner, text) + text);
}

std::int64_t position_of(const std::string& secret, const std::string& owner,
                         const std::string& cursor) {
    const std::string bytes = api::decode_base64(cursor).value_or("");
    std::int64_t position = 0;
    if (bytes.size() > code_bytes) {
        const std::string_view text = std::string_view(bytes).substr(code_bytes);
        const auto read = std::from_chars(text.data(), text.data() + text.size(), position);
        if (read.ec == std::errc() && read.ptr == text.data() + text.size() &&
            equal_in_constant_time(bytes.substr(0, code_bytes), cursor_code(secret, owner, text))) {
            return position;
        }
    }
    api::refuse("cursor_invalid", "the cursor is not one that this list gave");
}

JobFilter filter_of(const std::string& secret, const Request& request) {
    JobFilter filter;
    for (const auto& [name, value] : request.query) {
        if (name == "state") {
            filter.state = api::value_of(api::job_states, value);
            if (!filter.state)
                api::refuse("parameter_invalid", "state is one of " + api::listed(api::job_states));
        } else if (name == "tag") {
            filter.tag = value;
        } else if (name == "created_after") {
            filter.created_after_ms = api::rfc3339_ms(value);
            if (!filter.created_after_ms)
                api::refuse("parameter_invalid",
                            "created_after is a time such as 2026-03-01T08:00:00Z");
        } else if (name == "limit") {
            std::size_t limit = 0;
            const auto read = std::from_chars(value.data(), value.data() + value.size(), limit);
            if (read.ec != std::errc() || read.ptr != value.data() + value.size() || limit < 1 ||
                limit > most_listed)
                api::refuse("parameter_invalid",
                            "limit is a number from 1 to " + std::to_string(most_listed));
            filter.limit = limit;
        } else if (name == "cursor") {
            filter.before = position_of(secret, request.principal, value);
        }
    }
    return filter;
}

Response list_jobs(JobStore& store, const JobView& view, const std::string& secret,
                   const Request& request) {
    const JobFilter filter = filter_of(secret, request);
    const JobList jobs = store.list(request.principal, filter);
    api::JobList list;
    for (const JobRecord& job : jobs.jobs) list.items.push_back(view.of(job));
    std::string link;
    if (jobs.next) {
        list.next_cursor = cursor_of(secret, request.principal, *jobs.next);
        link = "</v1/jobs?limit=" + std::to_string(filter.limit);
        for (const char* name : {"state", "tag", "created_after"}) {
            if (const auto value = request.query.find(name); value != request.query.end())
                link += "&" + std::string(name) + "=" + http::percent_encoded(value->second);
        }
        link += "&cursor=" + list.next_cursor + ">; rel=\"next\"";
    }
    Response response = json_response(200, to_json(list));
    if (!link.empty()) response.headers.emplace_back("Link", link);
    return response;
}

}  // namespace

http::Route job_list_route(JobStore& jobs, const JobView& view, const std::string& secret) {
    return {"GET",
            "/v1/jobs",
            [&jobs, &view, secret](const Request& request) {
                return list_jobs(jobs, view, secret, request);
            },
            false,
            false,
            {"state", "tag", "created_after", "limit", "cursor"}};
}

}  // namespace lastflat::server
