#include "core/load/first_bytes.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include "core/error.h"
#include "core/load/byte_order.h"

namespace lastflat {
namespace {

constexpr std::string_view what_is_read = "send OBJ, STL, PLY, glTF or GLB";

/// The same whatever the case of letters; `start` is in small ones.
bool starts_as(std::string_view text, std::string_view start) {
    if (text.size() < start.size()) return false;
    for (std::size_t i = 0; i < start.size(); ++i) {
        const char c = text[i];
        if ((c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c) != start[i]) return false;
    }
    return true;
}

/// The name of a known format that is not read, or nothing.
std::string_view unread_format(std::string_view bytes) {
    struct Magic {
        std::string_view start, format;
    };
    static constexpr std::array formats{
        Magic{"\xFF\xFE", "UTF-16 text"},
        Magic{"\xFE\xFF", "UTF-16 text"},
        Magic{"OFF", "OFF"},
        Magic{"COFF", "OFF"},
        Magic{"PK\x03\x04", "ZIP"},
        Magic{"\x1F\x8B", "gzip"},
        Magic{"7z\xBC\xAF\x27\x1C", "7z"},
        Magic{"Rar!", "RAR"},
        Magic{"ISO-10303-21", "STEP"},
        Magic{"3D Geometry File Format", "Rhino 3DM"},
        Magic{"Kaydara FBX Binary", "FBX"},
        Magic{"BLENDER", "Blender's own format"},
        Magic{"\x89PNG", "a picture (PNG)"},
        Magic{"\xFF\xD8\xFF", "a picture (JPEG)"},
        Magic{"GIF8", "a picture (GIF)"},
        Magic{"RIFF", "a picture or sound (RIFF)"},
        Magic{"%PDF-", "PDF"},
    };
    for (const Magic& magic : formats) {
        if (bytes.starts_with(magic.start)) return magic.format;
    }
    return {};
}

[[noreturn]] void refuse(const std::string& what) {
    throw Error(ErrorCode::unreadable_model, what + "; " + std::string(what_is_read));
}

void check_glb_header(std::string_view bytes) {
    constexpr std::size_t header = 12;
    if (bytes.size() < header) refuse("GLB: the file ends inside its header");
    const std::uint32_t announced =
        read_unsigned<std::uint32_t>(bytes.substr(8), ByteOrder::little);
    if (announced > bytes.size())
        refuse("GLB: the file is cut off: it announces " + std::to_string(announced) +
               " bytes and has " + std::to_string(bytes.size()));
}

}  // namespace

void check_first_bytes(std::string_view bytes) {
    constexpr std::size_t looked_at = 4096;
    const std::string_view first = bytes.substr(0, looked_at);
    if (bytes.empty()) throw Error(ErrorCode::unreadable_model, "the model is empty (0 bytes)");
    if (const auto format = unread_format(first); !format.empty())
        throw Error(ErrorCode::unsupported_model, "the model is " + std::string(format) +
                                                      ", which this version does not read; " +
                                                      std::string(what_is_read));
    if (first.starts_with("glTF")) return check_glb_header(bytes);
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    std::string_view text = first;
    if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
    if (text.empty() && bytes.size() <= looked_at) refuse("the model has nothing but spaces");
    for (const std::string_view page : {"<!doctype", "<html", "<?xml", "<svg"}) {
        if (starts_as(text, page)) refuse("the model is a web page or XML");
    }
    if (first.find_first_not_of('\0') == std::string_view::npos) refuse("the model is zeros");
}

}  // namespace lastflat
