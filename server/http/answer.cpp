#include "server/http/answer.h"

#include <algorithm>
#include <array>
#include <ctime>
#include <string_view>

#include "server/http/refusal.h"
#include "server/http/text.h"

namespace lastflat::http {
namespace {

std::string_view reason(int status) {
    switch (status) {
        case 204: return "No Content";
        case 400: return "Bad Request";
        case 404: return "Not Found";
        case 405: return "Method Not Allowed";
        case 408: return "Request Timeout";
        case 413: return "Content Too Large";
        case 414: return "URI Too Long";
        case 415: return "Unsupported Media Type";
        case 417: return "Expectation Failed";
        case 431: return "Request Header Fields Too Large";
        case 500: return "Internal Server Error";
        case 501: return "Not Implemented";
        case 503: return "Service Unavailable";
        case 505: return "HTTP Version Not Supported";
        default: return "Answer";
    }
}

/// IMF-fixdate of RFC 9110, 5.6.7, by hand because strftime follows the locale.
std::string date_now() {
    constexpr std::array<const char*, 7> days = {"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
    constexpr std::array<const char*, 12> months = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                    "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%s, %02d %s %d %02d:%02d:%02d GMT",
                  days[static_cast<std::size_t>(utc.tm_wday)], utc.tm_mday,
                  months[static_cast<std::size_t>(utc.tm_mon)], utc.tm_year + 1900, utc.tm_hour,
                  utc.tm_min, utc.tm_sec);
    return text.data();
}

bool frames_the_message(std::string_view name) {
    constexpr std::array<std::string_view, 7> framing = {
        "content-length", "transfer-encoding", "connection", "keep-alive",
        "content-type",   "trailer",           "upgrade"};
    return std::find(framing.begin(), framing.end(), lower_case(name)) != framing.end();
}

}  // namespace

std::vector<std::pair<std::string, std::string>> outgoing_headers(const Response& response) {
    std::vector<std::pair<std::string, std::string>> headers = {
        {"Date", date_now()}, {"X-Content-Type-Options", "nosniff"}};
    for (const auto& [name, value] : response.headers) {
        if (is_token(name) && !frames_the_message(name) && !has_control_characters(value)) {
            headers.emplace_back(name, value);
        }
    }
    return headers;
}

std::string outgoing_media_type(const Response& response) {
    const std::string& type = response.media_type;
    return type.empty() || has_control_characters(type) ? "application/octet-stream" : type;
}

std::string answer_bytes(const Response& response, bool without_body) {
    const std::string_view body = response.body ? std::string_view(*response.body) : "";
    std::string bytes = "HTTP/1.1 " + std::to_string(response.status) + " ";
    bytes += reason(response.status);
    bytes += "\r\nConnection: close\r\n";
    for (const auto& [name, value] : outgoing_headers(response)) {
        bytes.append(name).append(": ").append(value).append("\r\n");
    }
    if (!body.empty()) bytes += "Content-Type: " + outgoing_media_type(response) + "\r\n";
    if (response.status != 204) {
        bytes += "Content-Length: " + std::to_string(body.size()) + "\r\n";
    }
    bytes += "\r\n";
    if (!without_body && response.status != 204) bytes += body;
    return bytes;
}

api::Refusal overloaded() {
    return api::Refusal("server_busy", "The server has all the work it can take. Try again later.")
        .with_header("Retry-After", "5");
}

api::Refusal client_busy() {
    return api::Refusal("client_busy",
                        "This client has half of all connections, and as many requests waiting as "
                        "one client may have. Wait for answers before asking more.")
        .with_header("Retry-After", "1");
}

Response answer_to(const Request& request, const std::exception_ptr& thrown,
                   const ProblemMaker& problem) noexcept {
    try {
        return problem(request, thrown);
    } catch (...) {
        Response bare;
        bare.status = 500;
        return bare;
    }
}

}  // namespace lastflat::http
