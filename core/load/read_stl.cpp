#include "core/load/read_stl.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>

#include "core/load/byte_order.h"
#include "core/load/text_scanner.h"
#include "core/utf8.h"

namespace lastflat {
namespace {

constexpr std::size_t header_bytes = 84, facet_bytes = 50;

bool has_word(std::string_view text, std::string_view word) {
    const auto same = [](char a, char b) { return (a | 0x20) == b; };
    return std::search(text.begin(), text.end(), word.begin(), word.end(), same) != text.end();
}

/// Without the empty lines and the comments that some programs write before the first solid.
std::string_view without_comments(std::string_view text) {
    for (;;) {
        const auto first = text.find_first_not_of(" \t\r\n");
        if (first == std::string_view::npos) return {};
        text.remove_prefix(first);
        if (text.front() != '#') return text;
        (void)take_line(text);
    }
}

bool is_text(std::string_view bytes) {
    constexpr std::size_t look = 2048;
    const std::string_view begin = without_comments(bytes).substr(0, look);
    return has_word(begin.substr(0, 6), "solid") && begin.find('\0') == std::string_view::npos &&
           (has_word(begin, "facet") || has_word(begin, "endsolid"));
}

std::uint64_t announced(std::string_view bytes) {
    return read_unsigned<std::uint32_t>(bytes.substr(80), ByteOrder::little);
}

bool fits_exactly(std::string_view bytes) {
    return bytes.size() >= header_bytes &&
           bytes.size() == header_bytes + announced(bytes) * facet_bytes;
}

/// Whether there are all triangles that the file announces, and perhaps more.
bool holds_announced(std::string_view bytes) {
    return bytes.size() > header_bytes && announced(bytes) > 0 &&
           announced(bytes) <= (bytes.size() - header_bytes) / facet_bytes;
}

/// Whether what follows the header may be a facet: a normal, and three corners.
bool begins_with_facet(std::string_view bytes) {
    constexpr double longest_normal = 1.01;
    if (bytes.size() < header_bytes + facet_bytes) return false;
    std::string_view facet = bytes.substr(header_bytes);
    std::array<double, 12> numbers{};
    for (double& number : numbers) {
        number = static_cast<double>(read_float<float>(facet, ByteOrder::little));
        if (!std::isfinite(number)) return false;
        facet.remove_prefix(4);
    }
    return std::hypot(numbers[0], numbers[1], numbers[2]) < longest_normal;
}

void add_triangle(RawMesh& mesh, const LoadLimits& limits, std::uint32_t label) {
    const auto last = static_cast<Index>(mesh.positions.size());
    if (mesh.triangles.size() >= limits.triangles)
        throw Error(ErrorCode::model_too_large,
                    "STL: more than " + std::to_string(mesh.triangles.size()) + " triangles");
    mesh.triangles.push_back({last - 3, last - 2, last - 1});
    mesh.triangle_labels.push_back(label);
}

Warning left_over(std::size_t bytes, std::uint64_t triangles) {
    const std::size_t more = bytes / facet_bytes;
    return {"trailing_bytes",
            "STL: " + std::to_string(bytes) + " bytes follow the " + std::to_string(triangles) +
                " triangles that the file announces" +
                (more > 0 ? " (room for " + std::to_string(more) + " more)" : "") +
                "; they were passed over",
            std::nullopt};
}

RawMesh read_binary(std::string_view bytes, const LoadLimits& limits) {
    const std::size_t body = bytes.size() - header_bytes;
    std::uint64_t count = announced(bytes);
    if (!holds_announced(bytes)) {
        if (body % facet_bytes != 0 || body == 0)
            throw Error(ErrorCode::unreadable_model,
                        "STL: " + std::to_string(count) + " triangles are announced, and " +
                            std::to_string(body) + " bytes follow, where " +
                            std::to_string(count * facet_bytes) +
                            " are needed; the file was cut off");
        count = body / facet_bytes;
    }
    if (count > limits.triangles)
        throw Error(ErrorCode::model_too_large, "STL: " + std::to_string(count) +
                                                    " triangles; at most " +
                                                    std::to_string(limits.triangles) + " are read");
    RawMesh mesh;
    if (body > count * facet_bytes)
        mesh.warnings.push_back(left_over(body - count * facet_bytes, count));
    mesh.label_sets.emplace_back();
    mesh.positions.reserve(3 * count);
    for (std::uint64_t t = 0; t < count; ++t) {
        std::string_view facet = bytes.substr(header_bytes + t * facet_bytes + 12, 36);
        for (int corner = 0; corner < 3; ++corner) {
            Vec3 position;
            for (Eigen::Index i = 0; i < 3; ++i, facet.remove_prefix(4))
                position[i] = static_cast<double>(read_float<float>(facet, ByteOrder::little));
            if (!position.allFinite())
                throw Error(ErrorCode::mesh_degenerate, "STL: a coordinate of triangle " +
                                                            std::to_string(t) + " is not finite");
            mesh.positions.push_back(position);
        }
        add_triangle(mesh, limits, 0);
    }
    return mesh;
}

class TextReader {
public:
    TextReader(std::string_view text, const LoadLimits& limits)
        : scanner_(text, "STL"), limits_(limits) {
        mesh_.label_sets.emplace_back();
    }

    RawMesh read() {
        while (!scanner_.at_end()) {
            const std::string word = lower(scanner_.next_word());
            if (word == "solid") {
                label_ = label_of(scanner_.rest_of_line());
            } else if (word == "facet") {
                read_facet();
            } else if (word == "endsolid" || word.front() == '#') {
                (void)scanner_.rest_of_line();
            } else {
                scanner_.fail("'" + word.substr(0, 40) + "' where a facet should begin");
            }
        }
        return std::move(mesh_);
    }

private:
    static std::string lower(std::string_view word) {
        std::string result(word);
        for (char& c : result) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c | 0x20) : c;
        return result;
    }
    void expect(std::string_view wanted) {
        const std::string_view word = scanner_.next_word();
        if (lower(word) != wanted)
            scanner_.fail("'" + std::string(word.substr(0, 40)) + "' where '" +
                          std::string(wanted) + "' is needed");
    }
    void read_facet() {
        (void)scanner_.rest_of_line();  // the normal
        expect("outer");
        expect("loop");
        for (int corner = 0; corner < 3; ++corner) {
            expect("vertex");
            Vec3 position;
            for (Eigen::Index i = 0; i < 3; ++i) position[i] = scanner_.next_number();
            mesh_.positions.push_back(position);
        }
        expect("endloop");
        expect("endfacet");
        add_triangle(mesh_, limits_, label_);
    }
    std::uint32_t label_of(std::string_view solid) {
        if (solid.size() > limits_.name_bytes)
            scanner_.fail("a name is too long", ErrorCode::model_too_large);
        if (solid.empty()) return 0;
        const auto next = static_cast<std::uint32_t>(mesh_.label_sets.size());
        const auto [found, is_new] = labels_.try_emplace(as_utf8(solid), next);
        if (is_new) {
            if (next >= limits_.name_sets)
                scanner_.fail("too many solids", ErrorCode::model_too_large);
            mesh_.label_sets.push_back({found->first});
        }
        return found->second;
    }

    TextScanner scanner_;
    const LoadLimits& limits_;
    RawMesh mesh_;
    std::map<std::string, std::uint32_t> labels_;
    std::uint32_t label_ = 0;
};

}  // namespace

bool is_stl(std::string_view bytes) {
    if (fits_exactly(bytes) || is_text(bytes)) return true;
    // A binary file whose count lies: its header is text or zeros, and what follows is no text.
    return bytes.size() > header_bytes &&
           bytes.substr(80).substr(0, 512).find('\0') != std::string_view::npos &&
           (holds_announced(bytes) || (bytes.size() - header_bytes) % facet_bytes == 0 ||
            (announced(bytes) > (bytes.size() - header_bytes) / facet_bytes &&
             begins_with_facet(bytes)));
}

RawMesh read_stl(std::string_view bytes, const LoadLimits& limits) {
    if (bytes.size() < header_bytes && !is_text(bytes))
        throw Error(ErrorCode::unreadable_model, "STL: the file ends inside its header");
    RawMesh mesh = !fits_exactly(bytes) && is_text(bytes) ? TextReader(bytes, limits).read()
                                                          : read_binary(bytes, limits);
    mesh.indexed = false;
    if (mesh.triangles.empty())
        throw Error(ErrorCode::unreadable_model, "STL: the file has no triangle");
    return mesh;
}

}  // namespace lastflat
