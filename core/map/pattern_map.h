// From the last to the pattern and back, point by point.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/numerics/triangle_search.h"

namespace lastflat {

/// One piece of a pattern, as `write_flat_obj` writes it.
struct FlatPiece {
    std::string name;
    Points3 positions;  ///< on the last, mm
    Points2 uv;         ///< flat, mm
    std::vector<Triangle> triangles;
};

/// Reads what `write_flat_obj` wrote.
/// Throws: Error{unreadable_model} naming the line.
[[nodiscard]] std::vector<FlatPiece> read_flat_obj(std::string_view text);

/// Paper: [kim-kim], Fig. 7: what is drawn on the last is seen on the pattern. The map is linear on
///        every triangle, so it is exact at vertices and the way there and back ends where it
///        began.
class PatternMap {
public:
    explicit PatternMap(std::vector<FlatPiece> pieces);

    /// The same triangles, flat somewhere else: per piece its `uv`.
    void move_to(const std::vector<Points2>& charts);

    struct OnPattern {
        std::string piece;
        Vec2 uv;
        double distance;  ///< of the point from the last, mm
    };
    /// The nearest point of one piece, or of all; on a cut, of the first of its pieces.
    /// Throws: Error{region_invalid} if there is no such piece.
    [[nodiscard]] OnPattern to_pattern(const Vec3& position,
                                       const std::optional<std::string>& piece = {}) const;

    struct OnLast {
        Vec3 position;
        double distance;  ///< of the point from the piece, mm; 0 inside
    };
    /// Throws: Error{region_invalid} if there is no such piece.
    [[nodiscard]] OnLast to_last(const std::string& piece, const Vec2& uv);

private:
    struct Searched {
        FlatPiece piece;
        TriangleSearch last;
        std::unique_ptr<const TriangleSearch> pattern{};  ///< made when it is needed
    };
    [[nodiscard]] std::size_t index_of(const std::string& piece) const;

    std::vector<Searched> pieces_;
};

}  // namespace lastflat
