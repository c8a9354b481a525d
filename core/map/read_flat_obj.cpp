#include "core/load/text_scanner.h"
#include "core/map/pattern_map.h"

namespace lastflat {
namespace {

/// "12/12": the same number for the point on the last and the flat one.
Index corner(TextScanner& scanner, std::size_t before, std::size_t count) {
    const std::string_view word = scanner.next_word();
    std::size_t number = 0;
    const std::string_view first = word.substr(0, word.find('/'));
    const auto [end, status] = std::from_chars(first.data(), first.data() + first.size(), number);
    if (status != std::errc() || end != first.data() + first.size() || number <= before ||
        number > before + count)
        scanner.fail("'" + std::string(word.substr(0, 40)) + "' is no corner of its piece");
    return static_cast<Index>(number - before - 1);
}

}  // namespace

std::vector<FlatPiece> read_flat_obj(std::string_view text) {
    TextScanner scanner(text, "flat.obj");
    std::vector<FlatPiece> pieces;
    std::size_t before = 0;
    while (!scanner.at_end()) {
        const std::string_view word = scanner.next_word();
        if (word == "g") {
            if (!pieces.empty()) before += pieces.back().positions.size();
            pieces.push_back({std::string(scanner.rest_of_line()), {}, {}, {}});
            continue;
        }
        if (word.front() == '#') {
            (void)scanner.rest_of_line();
            continue;
        }
        if (pieces.empty()) scanner.fail("a line before the first piece: is this a flat.obj?");
        FlatPiece& piece = pieces.back();
        if (word == "v") {
            const double x = scanner.next_number(), y = scanner.next_number();
            piece.positions.emplace_back(x, y, scanner.next_number());
        } else if (word == "vt") {
            const double u = scanner.next_number();
            piece.uv.emplace_back(u, scanner.next_number());
        } else if (word == "f") {
            const std::size_t count = std::min(piece.positions.size(), piece.uv.size());
            Triangle triangle{};
            for (Index& v : triangle) v = corner(scanner, before, count);
            piece.triangles.push_back(triangle);
        } else {
            scanner.fail("'" + std::string(word.substr(0, 40)) + "' is not of a flat.obj");
        }
    }
    for (const FlatPiece& piece : pieces) {
        if (piece.triangles.empty() || piece.uv.size() != piece.positions.size())
            scanner.fail("the piece '" + piece.name + "' is not complete");
    }
    if (pieces.empty()) scanner.fail("there is no piece: is this a flat.obj?");
    return pieces;
}

}  // namespace lastflat
