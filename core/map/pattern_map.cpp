#include "core/map/pattern_map.h"

#include <algorithm>

#include "core/error.h"

namespace lastflat {
namespace {

Triangulation flat(const FlatPiece& piece) {
    Triangulation result{{}, piece.triangles};
    for (const Vec2& p : piece.uv) result.positions.emplace_back(p.x(), p.y(), 0.0);
    return result;
}

/// The weighted mean of a triangle's corners.
template <class Points>
typename Points::value_type mean(const FlatPiece& piece, const Points& positions,
                                 const TriangleSearch::Nearest& at) {
    const Triangle& t = piece.triangles[static_cast<std::size_t>(at.triangle)];
    const auto corner = [&](std::size_t i) { return positions[static_cast<std::size_t>(t[i])]; };
    return at.weights[0] * corner(0) + at.weights[1] * corner(1) + at.weights[2] * corner(2);
}

}  // namespace

PatternMap::PatternMap(std::vector<FlatPiece> pieces) {
    for (FlatPiece& piece : pieces) {
        TriangleSearch last(Triangulation{piece.positions, piece.triangles});
        pieces_.push_back({std::move(piece), std::move(last)});
    }
}

void PatternMap::move_to(const std::vector<Points2>& charts) {
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        pieces_[i].piece.uv = charts[i];
        pieces_[i].pattern.reset();
    }
}

std::size_t PatternMap::index_of(const std::string& piece) const {
    const auto found = std::find_if(pieces_.begin(), pieces_.end(), [&](const Searched& searched) {
        return searched.piece.name == piece;
    });
    if (found == pieces_.end())
        throw Error(ErrorCode::region_invalid, "the pattern has no piece '" + piece + "'");
    return static_cast<std::size_t>(found - pieces_.begin());
}

PatternMap::OnPattern PatternMap::to_pattern(const Vec3& position,
                                             const std::optional<std::string>& piece) const {
    const Searched* best = piece ? &pieces_[index_of(*piece)] : nullptr;
    TriangleSearch::Nearest nearest;
    if (best != nullptr) nearest = best->last.nearest(position);
    for (std::size_t i = 0; !piece && i < pieces_.size(); ++i) {
        const auto found = pieces_[i].last.nearest(position);
        if (best != nullptr && found.distance >= nearest.distance) continue;
        best = &pieces_[i];
        nearest = found;
    }
    if (best == nullptr || nearest.triangle < 0)
        throw Error(ErrorCode::region_invalid, "the pattern has no piece");
    return {best->piece.name, mean(best->piece, best->piece.uv, nearest), nearest.distance};
}

PatternMap::OnLast PatternMap::to_last(const std::string& piece, const Vec2& uv) {
    Searched& of = pieces_[index_of(piece)];
    if (!of.pattern) of.pattern = std::make_unique<const TriangleSearch>(flat(of.piece));
    const auto nearest = of.pattern->nearest({uv.x(), uv.y(), 0.0});
    if (nearest.triangle < 0)
        throw Error(ErrorCode::region_invalid, "the piece '" + piece + "' has no triangle");
    return {mean(of.piece, of.piece.positions, nearest), nearest.distance};
}

}  // namespace lastflat
