#include "server/http/text.h"

#include <algorithm>
#include <cstddef>

namespace lastflat::http {
namespace {

char lower_letter(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
}

std::optional<int> hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    const char low = lower_letter(c);
    if (low >= 'a' && low <= 'f') return low - 'a' + 10;
    return std::nullopt;
}

bool is_token_character(char c) {
    if ((c >= '0' && c <= '9') || (lower_letter(c) >= 'a' && lower_letter(c) <= 'z')) return true;
    return c != '\0' && std::string_view("!#$%&'*+-.^_`|~").find(c) != std::string_view::npos;
}

/// Reads a quoted string whose opening quote is at `at`; leaves `at` behind the closing one.
/// Nothing if it is not closed.
std::optional<std::string> quoted_string(std::string_view text, std::size_t& at) {
    std::string content;
    for (++at; at < text.size(); ++at) {
        if (text[at] == '"') {
            ++at;
            return content;
        }
        const bool escape = text[at] == '\\' && at + 1 < text.size() &&
                            (text[at + 1] == '"' || text[at + 1] == '\\');
        if (escape) ++at;
        content += text[at];
    }
    return std::nullopt;
}

}  // namespace

std::string lower_case(std::string_view text) {
    std::string lowered(text);
    std::transform(lowered.begin(), lowered.end(), lowered.begin(),
                   [](char c) { return lower_letter(c); });
    return lowered;
}

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

bool is_token(std::string_view text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), is_token_character);
}

bool has_control_characters(std::string_view text) {
    return std::any_of(text.begin(), text.end(),
                       [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; });
}

std::optional<std::string> percent_decoded(std::string_view text, bool plus_is_space) {
    std::string decoded;
    decoded.reserve(text.size());
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (text[at] == '+' && plus_is_space) {
            decoded += ' ';
        } else if (text[at] != '%') {
            decoded += text[at];
        } else {
            if (text.size() - at < 3) return std::nullopt;
            const auto high = hex_digit(text[at + 1]);
            const auto low = hex_digit(text[at + 2]);
            if (!high || !low) return std::nullopt;
            decoded += static_cast<char>(*high * 16 + *low);
            at += 2;
        }
    }
    return decoded;
}

std::string percent_encoded(std::string_view text) {
    constexpr char digits[] = "0123456789ABCDEF";
    std::string encoded;
    for (const char c : text) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                           (c >= '0' && c <= '9') || c == '-' || c == '.' || c == '_' || c == '~';
        const auto byte = static_cast<unsigned char>(c);
        if (plain)
            encoded += c;
        else
            encoded.append({'%', digits[byte >> 4], digits[byte & 15u]});
    }
    return encoded;
}

std::string media_type_of(std::string_view content_type) {
    return lower_case(trimmed(content_type.substr(0, content_type.find(';'))));
}

std::optional<std::string> parameter_of(std::string_view value, std::string_view name) {
    std::size_t at = value.find(';');
    while (at < value.size()) {
        ++at;  // over the ';'
        const std::size_t name_end = value.find_first_of("=;", at);
        if (name_end == std::string_view::npos) return std::nullopt;
        const std::string_view found = trimmed(value.substr(at, name_end - at));
        at = name_end;
        if (value[at] == ';') continue;
        at = value.find_first_not_of(" \t", at + 1);
        if (at == std::string_view::npos) return std::nullopt;
        std::string content;
        if (value[at] == '"') {
            auto quoted = quoted_string(value, at);
            if (!quoted) return std::nullopt;
            content = std::move(*quoted);
            at = value.find(';', at);
        } else {
            const std::size_t end = value.find(';', at);
            content = trimmed(value.substr(at, end == std::string_view::npos ? end : end - at));
            at = end;
        }
        if (lower_case(found) == name) return content;
    }
    return std::nullopt;
}

}  // namespace lastflat::http
