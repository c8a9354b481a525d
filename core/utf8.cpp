#include "core/utf8.h"

#include <cstdint>
#include <optional>

namespace lastflat {
namespace {

/// How many bytes follow a first byte of UTF-8, and which code points they may give.
struct Utf8Form {
    int following;
    std::uint32_t first_bits;
    std::uint32_t smallest;
};

std::optional<Utf8Form> utf8_form(unsigned char first) {
    if (first < 0x80) return Utf8Form{0, first, 0};
    if (first >= 0xC2 && first < 0xE0) return Utf8Form{1, first & 0x1Fu, 0x80};
    if (first >= 0xE0 && first < 0xF0) return Utf8Form{2, first & 0x0Fu, 0x800};
    if (first >= 0xF0 && first < 0xF5) return Utf8Form{3, first & 0x07u, 0x10000};
    return std::nullopt;
}

}  // namespace

bool is_utf8(std::string_view text) {
    for (std::size_t at = 0; at < text.size();) {
        const auto form = utf8_form(static_cast<unsigned char>(text[at++]));
        if (!form) return false;
        std::uint32_t point = form->first_bits;
        for (int i = 0; i < form->following; ++i, ++at) {
            if (at == text.size()) return false;
            const auto byte = static_cast<unsigned char>(text[at]);
            if ((byte & 0xC0u) != 0x80u) return false;
            point = point << 6 | (byte & 0x3Fu);
        }
        const bool surrogate = point >= 0xD800 && point <= 0xDFFF;
        if (point < form->smallest || point > 0x10FFFF || surrogate) return false;
    }
    return true;
}

std::string as_utf8(std::string_view text) {
    std::string result(text);
    if (is_utf8(text)) return result;
    result.clear();
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x80) {
            result += c;
        } else {
            result += static_cast<char>(0xC0u | byte >> 6);
            result += static_cast<char>(0x80u | (byte & 0x3Fu));
        }
    }
    return result;
}

}  // namespace lastflat
