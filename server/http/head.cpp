// Based on: RFC 9112 (messages) and RFC 9110 (semantics), stricter where they leave a choice.
#include "server/http/head.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string>
#include <utility>
#include <vector>

#include "core/utf8.h"
#include "server/http/text.h"

namespace lastflat::http {
namespace {

struct RequestLine {
    std::string_view method;
    std::string_view target;
    bool is_http_1_0 = false;
};

/// The lines of the head without their ends, the closing empty one left out.
std::vector<std::string_view> split_lines(std::string_view raw, std::size_t most_lines) {
    std::vector<std::string_view> lines;
    while (true) {
        const std::size_t end = raw.find_first_of("\r\n");
        if (end == std::string_view::npos || raw.substr(end, 2) != line_end) {
            throw api::Refusal(
                "bad_line_end",
                "The request's head is broken: every line must end with CR LF and the "
                "head with an empty line. Is this plain HTTP, not HTTPS?");
        }
        if (end == 0) return lines;
        if (lines.size() > most_lines) {
            throw api::Refusal("too_many_headers", "The request has more than " +
                                                       std::to_string(most_lines) +
                                                       " header lines. Send fewer.");
        }
        lines.push_back(raw.substr(0, end));
        raw.remove_prefix(end + line_end.size());
    }
}

void check_version(std::string_view version) {
    if (version == "HTTP/1.1" || version == "HTTP/1.0") return;
    if (version.size() == 8 && version.substr(0, 5) == "HTTP/") {
        throw api::Refusal("version_not_supported",
                           "This server speaks HTTP/1.1 and HTTP/1.0. Use one of these.");
    }
    throw api::Refusal(
        "bad_request_line",
        "The request line must be a method, a target and HTTP/1.1, one space between.");
}

RequestLine parse_request_line(std::string_view line) {
    const std::size_t method_end = line.find(' ');
    const std::size_t target_end = line.rfind(' ');
    if (method_end == std::string_view::npos || target_end == method_end) check_version("");
    RequestLine parts;
    parts.method = line.substr(0, method_end);
    parts.target = line.substr(method_end + 1, target_end - method_end - 1);
    const std::string_view version = line.substr(target_end + 1);
    check_version(is_token(parts.method) ? version : "");
    parts.is_http_1_0 = version == "HTTP/1.0";
    return parts;
}

void check_target(std::string_view target) {
    if (target.size() > longest_target) {
        throw api::Refusal("target_too_long", "The request target is longer than " +
                                                  std::to_string(longest_target) +
                                                  " bytes. Put the data into the body.");
    }
    const bool visible = std::all_of(target.begin(), target.end(),
                                     [](char c) { return c > 0x20 && c < 0x7F && c != '#'; });
    if (target.empty() || target[0] != '/' || !visible) {
        throw api::Refusal(
            "bad_target",
            "The request target must be a path that starts with '/', with every byte "
            "outside visible ASCII, and '#', percent-encoded.");
    }
}

std::string decoded(std::string_view text, bool plus_is_space) {
    const auto result = percent_decoded(text, plus_is_space);
    if (!result || has_control_characters(*result) || !is_utf8(*result)) {
        throw api::Refusal("bad_target",
                           "The request target has a broken percent-encoding, an encoded control "
                           "character, or bytes that are not UTF-8.");
    }
    return *result;
}

std::map<std::string, std::string> parse_query(std::string_view query) {
    std::map<std::string, std::string> parameters;
    while (!query.empty()) {
        const std::string_view pair = query.substr(0, query.find('&'));
        query.remove_prefix(std::min(query.size(), pair.size() + 1));
        if (pair.empty()) continue;
        const std::size_t equals = std::min(pair.find('='), pair.size());
        const std::string_view value = pair.substr(std::min(equals + 1, pair.size()));
        const auto added =
            parameters.emplace(decoded(pair.substr(0, equals), true), decoded(value, true));
        if (!added.second) {
            throw api::Refusal("repeated_parameter", "The query has the parameter '" +
                                                         added.first->first +
                                                         "' more than once. Send it once.");
        }
    }
    return parameters;
}

bool must_be_single(std::string_view name) {
    constexpr std::array<std::string_view, 8> names = {
        "host",   "content-length", "transfer-encoding", "content-type", "authorization",
        "expect", "range",          "idempotency-key"};
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// Encoded line ends are refused too: a value may be decoded by whoever reads it later.
bool is_clean_value(std::string_view value) {
    const bool controls = std::any_of(value.begin(), value.end(), [](char c) {
        return (static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == 0x7F;
    });
    const std::string low = lower_case(value);
    const auto has = [&](const char* encoded) { return low.find(encoded) != std::string::npos; };
    return !controls && !has("%0d") && !has("%0a") && !has("%00");
}

void add_header(std::map<std::string, std::string>& headers, std::string_view line) {
    const std::size_t colon = std::min(line.find(':'), line.size());
    const std::string name = lower_case(line.substr(0, colon));
    if (colon == line.size() || !is_token(name)) {
        throw api::Refusal(
            "bad_header",
            "A header line is not 'name: value'. Lines may not be folded, and no space "
            "may stand before the colon.");
    }
    const std::string_view value = trimmed(line.substr(colon + 1));
    if (!is_clean_value(value)) {
        throw api::Refusal("bad_header",
                           "The header '" + name +
                               "' has a control character in its value, plain or percent-encoded.");
    }
    const auto [field, added] = headers.emplace(name, value);
    if (added) return;
    if (must_be_single(name)) {
        throw api::Refusal("repeated_header",
                           "The header '" + name + "' is there more than once. Send it once.");
    }
    field->second.append(", ").append(value);
}

void check_host(const Request& request, bool is_http_1_0) {
    const std::string_view host = request.header("host");
    const bool clean = host.find_first_of(" \t/\\@,?#") == std::string_view::npos;
    if (!clean || (host.empty() && !is_http_1_0)) {
        throw api::Refusal("bad_host",
                           "The request needs one Host header with the server's name and port.");
    }
}

std::uint64_t parse_content_length(std::string_view text, const ServerLimits& limits) {
    const bool digits = !text.empty() && std::all_of(text.begin(), text.end(),
                                                     [](char c) { return c >= '0' && c <= '9'; });
    if (!digits) {
        throw api::Refusal("bad_content_length",
                           "Content-Length must be one number of decimal digits.");
    }
    std::uint64_t length = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), length);
    if (parsed.ec != std::errc() || length > limits.body_bytes) {
        throw api::Refusal("body_too_large", "The body may have at most " +
                                                 std::to_string(limits.body_bytes) +
                                                 " bytes. Send a smaller model.");
    }
    return length;
}

void check_framing(const Request& request, bool is_http_1_0) {
    if (!request.headers.contains("transfer-encoding")) return;
    if (request.headers.contains("content-length") || is_http_1_0) {
        throw api::Refusal(
            "ambiguous_length",
            "Transfer-Encoding may stand neither beside Content-Length nor in HTTP/1.0. "
            "Send one of the two.");
    }
    if (lower_case(request.header("transfer-encoding")) != "chunked") {
        throw api::Refusal("transfer_encoding_not_supported",
                           "The only Transfer-Encoding supported is 'chunked'.");
    }
}

void check_conditions(const Request& request) {
    if (request.headers.contains("expect") &&
        lower_case(request.header("expect")) != "100-continue") {
        throw api::Refusal("expectation_not_supported",
                           "The only expectation supported is '100-continue'.");
    }
    if (request.header("range").find(',') != std::string_view::npos) {
        throw api::Refusal("multiple_ranges", "Ask for the whole resource instead of ranges.");
    }
}

void check_body(const Head& head) {
    if (!head.has_body()) return;
    if (!head.route->takes_body) {
        throw api::Refusal("body_not_allowed", head.request.method + " " + head.request.path +
                                                   " takes no body. Send none.");
    }
    const std::string_view encoding = head.request.header("content-encoding");
    if (!encoding.empty() && lower_case(encoding) != "identity") {
        throw api::Refusal("content_encoding_not_supported",
                           "The body must not be compressed. Send it without Content-Encoding.");
    }
}

void check_method(std::string_view method) {
    constexpr std::array<std::string_view, 7> known = {"GET",   "HEAD",   "POST",   "PUT",
                                                       "PATCH", "DELETE", "OPTIONS"};
    if (std::find(known.begin(), known.end(), method) == known.end()) {
        throw api::Refusal("method_not_supported", "This server does not know this method.");
    }
}

void find_route(Head& head, const RouteTable& routes, std::string_view raw_path) {
    const std::string& method = head.request.method;
    RouteMatch match = routes.find(method, raw_path);
    head.route = match.route;
    head.request.captures = std::move(match.captures);
    if (head.route) return;
    const std::string allowed = routes.allowed(raw_path);
    if (allowed.empty() && routes.has_malformed_id(method, raw_path)) {
        throw api::Refusal("id_malformed",
                           "What stands in the path for an id is none: an id is 26 characters of "
                           "0-9 and A-Z or a UUID in small letters, an asset's 64 hexadecimal "
                           "digits.");
    }
    if (allowed.empty()) {
        throw api::Refusal("not_found", "There is nothing at this path. See /openapi.json.");
    }
    if (method == "OPTIONS") {
        head.route = &options_route();
        head.request.captures = {allowed};
        return;
    }
    throw api::Refusal("method_not_allowed",
                       "This path does not answer to " + method + ", only to " + allowed + ".")
        .with_header("Allow", allowed);
}

/// Whether a comma-separated list has the word, in any case.
bool has_item(std::string_view list, std::string_view word) {
    while (!list.empty()) {
        const std::size_t end = std::min(list.find(','), list.size());
        if (lower_case(trimmed(list.substr(0, end))) == word) return true;
        list.remove_prefix(std::min(end + 1, list.size()));
    }
    return false;
}

void read_meaning(Head& head, const RequestLine& line, const RouteTable& routes,
                  const ServerLimits& limits) {
    const std::string_view raw_path = line.target.substr(0, line.target.find('?'));
    check_host(head.request, line.is_http_1_0);
    check_framing(head.request, line.is_http_1_0);
    head.chunked = head.request.headers.contains("transfer-encoding");
    check_method(line.method);
    if (head.request.headers.contains("content-length")) {
        head.content_length = parse_content_length(head.request.header("content-length"), limits);
    }
    check_conditions(head.request);
    head.request.query =
        parse_query(line.target.substr(std::min(raw_path.size() + 1, line.target.size())));
    find_route(head, routes, raw_path);
    check_body(head);
    head.takes_chunks = !line.is_http_1_0;
    head.keeps_alive = !line.is_http_1_0 && !has_item(head.request.header("connection"), "close");
    head.awaits_continue =
        head.has_body() && head.request.headers.contains("expect") && !line.is_http_1_0;
}

void read_head(std::string_view raw, const RouteTable& routes, const ServerLimits& limits,
               Head& head) {
    const auto lines = split_lines(raw, limits.head_lines);
    if (lines.empty()) check_version("");
    const RequestLine line = parse_request_line(lines[0]);
    check_target(line.target);
    head.request.method = line.method;
    head.request.path = decoded(line.target.substr(0, line.target.find('?')), false);
    for (std::size_t i = 1; i < lines.size(); ++i) add_header(head.request.headers, lines[i]);
    read_meaning(head, line, routes, limits);
}

}  // namespace

std::optional<std::size_t> head_length(std::string_view bytes, std::size_t searched) {
    // A first byte that starts no method: TLS, most likely. What follows will not mend it.
    if (!bytes.empty() && !is_token(bytes.substr(0, 1))) return bytes.size();
    std::size_t at = searched;
    while ((at = bytes.find('\n', at)) != std::string_view::npos) {
        if (at == 0 || bytes[at - 1] != '\r') return at + 1;
        if (at >= 3 && bytes[at - 2] == '\n') return at + 1;
        ++at;
    }
    return std::nullopt;
}

std::string canonical_head(const Head& head) {
    std::string text = head.request.method + " " + head.request.path + " HTTP/1.1\r\n";
    if (head.awaits_continue) text += "Expect: 100-continue\r\n";
    return text + "\r\n";
}

Head vet_head(std::string_view raw, const RouteTable& routes, const ServerLimits& limits) {
    Head head;
    try {
        read_head(raw, routes, limits, head);
        return head;
    } catch (const api::Refusal& why) {
        throw RefusedHead(why, head.request.header("origin"), asks_for_head_only(raw));
    }
}

}  // namespace lastflat::http
