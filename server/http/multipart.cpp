#include "server/http/multipart.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "core/utf8.h"
#include "server/http/refusal.h"
#include "server/http/text.h"

namespace lastflat::http {
namespace {

constexpr std::size_t longest_part_head = 4096;

[[noreturn]] void refuse(const std::string& detail) {
    throw api::Refusal("bad_multipart", "The multipart body cannot be read: " + detail);
}

/// memmem rather than string_view::find: a body of nothing but CRs must not cost more than others.
std::size_t find_text(std::string_view text, std::string_view wanted) {
    const void* found = memmem(text.data(), text.size(), wanted.data(), wanted.size());
    if (!found) return std::string_view::npos;
    return static_cast<std::size_t>(static_cast<const char*>(found) - text.data());
}

std::string boundary_of(std::string_view content_type) {
    const auto boundary = parameter_of(content_type, "boundary");
    const auto is_boundary_character = [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
               (c != '\0' && std::string_view("'()+_,-./:=? ").find(c) != std::string_view::npos);
    };
    if (!boundary || boundary->empty() || boundary->size() > 70 || boundary->back() == ' ' ||
        !std::all_of(boundary->begin(), boundary->end(), is_boundary_character)) {
        refuse("Content-Type has no valid boundary of 1 to 70 characters.");
    }
    return *boundary;
}

/// What follows a delimiter: "--" ends the body, a line end starts a part.
enum class AfterDelimiter { part, end };

/// Reads the rest of a delimiter line off `rest`; nothing if this was no delimiter after all.
std::optional<AfterDelimiter> read_delimiter_tail(std::string_view& rest) {
    std::string_view after = rest;
    const bool last = after.substr(0, 2) == "--";
    if (last) after.remove_prefix(2);
    // Space after a delimiter is padding added on the way (RFC 2046).
    after.remove_prefix(std::min(after.find_first_not_of(" \t"), after.size()));
    if (after.substr(0, 2) == line_end) {
        rest = after.substr(2);
    } else if (last && after.empty()) {
        rest = after;
    } else {
        return std::nullopt;
    }
    return last ? AfterDelimiter::end : AfterDelimiter::part;
}

/// Cuts `rest` behind the next delimiter line and returns what stood before it.
std::pair<std::string_view, AfterDelimiter> cut_at_delimiter(std::string_view& rest,
                                                             std::string_view delimiter) {
    std::size_t from = 0;
    while (true) {
        const std::size_t found = find_text(rest.substr(from), delimiter);
        if (found == std::string_view::npos) {
            refuse("the closing boundary is missing, so the body was cut off. Send it again.");
        }
        const std::string_view before = rest.substr(0, from + found);
        std::string_view after = rest.substr(from + found + delimiter.size());
        if (const auto kind = read_delimiter_tail(after)) {
            rest = after;
            return {before, *kind};
        }
        // The boundary's text with something behind it is content (RFC 2046 calls it a mistake of
        // the sender, but a longer boundary of a nested body starts the same way).
        from += found + delimiter.size();
    }
}

std::string checked_text(const std::optional<std::string>& text, const char* what) {
    if (!text) return {};
    if (text->size() > 255 || has_control_characters(*text) || !is_utf8(*text)) {
        refuse(std::string(what) +
               " of a part must be UTF-8 of at most 255 bytes without control "
               "characters.");
    }
    return *text;
}

void read_part_header(BodyPart& part, bool& has_name, std::string_view line) {
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos || !is_token(line.substr(0, colon))) {
        refuse("a part has a header line that is not 'name: value'.");
    }
    const std::string header = lower_case(line.substr(0, colon));
    const std::string_view value = trimmed(line.substr(colon + 1));
    if (header == "content-disposition") {
        const auto name = parameter_of(value, "name");
        if (has_name || !name || media_type_of(value) != "form-data") {
            refuse("each part needs one Content-Disposition: form-data with a name.");
        }
        has_name = true;
        part.name = checked_text(name, "the name");
        part.file_name = checked_text(parameter_of(value, "filename"), "the file name");
    } else if (header == "content-type") {
        part.media_type = checked_text(media_type_of(value), "the type");
    } else if (header == "content-transfer-encoding") {
        const std::string encoding = lower_case(value);
        if (encoding != "binary" && encoding != "8bit" && encoding != "7bit") {
            refuse("parts must be sent as they are, without Content-Transfer-Encoding.");
        }
    }
}

BodyPart parse_part(std::string_view bytes) {
    BodyPart part;
    bool has_name = false;
    std::size_t head_bytes = 0;
    while (true) {
        const std::size_t end = find_text(bytes.substr(0, longest_part_head), line_end);
        head_bytes += end;
        if (end == std::string_view::npos || head_bytes > longest_part_head) {
            refuse("a part's headers are longer than " + std::to_string(longest_part_head) +
                   " bytes or do not end with an empty line.");
        }
        const std::string_view line = bytes.substr(0, end);
        bytes.remove_prefix(end + line_end.size());
        if (line.empty()) break;
        read_part_header(part, has_name, line);
    }
    if (!has_name) refuse("each part needs one Content-Disposition: form-data with a name.");
    part.bytes = bytes;
    return part;
}

}  // namespace

std::vector<BodyPart> parse_multipart(std::string_view content_type, std::string_view body,
                                      std::size_t most_parts) {
    const std::string delimiter = "\r\n--" + boundary_of(content_type);
    const std::string_view opening = std::string_view(delimiter).substr(line_end.size());
    std::string_view rest = body;
    auto kind = std::optional<AfterDelimiter>();
    if (rest.substr(0, opening.size()) == opening) {  // no line end before the first one
        std::string_view after = rest.substr(opening.size());
        kind = read_delimiter_tail(after);
        if (kind) rest = after;
    }
    if (!kind) kind = cut_at_delimiter(rest, delimiter).second;

    std::vector<BodyPart> parts;
    while (*kind == AfterDelimiter::part) {
        if (parts.size() == most_parts) {
            throw api::Refusal("too_many_parts", "The multipart body has more than " +
                                                     std::to_string(most_parts) +
                                                     " parts. Send fewer.");
        }
        const auto [part, next] = cut_at_delimiter(rest, delimiter);
        parts.push_back(parse_part(part));
        kind = next;
    }
    return parts;
}

}  // namespace lastflat::http
