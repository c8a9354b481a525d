// Based on: Umeyama, "Least-Squares Estimation of Transformation Parameters Between Two Point
// Patterns", IEEE PAMI 1991.
#include "core/constrain/pins.h"

#include "core/numerics/polygon.h"

namespace lastflat {

std::vector<PinnedVertex> pinned_vertices(const Region& region, const Pin& pin) {
    std::vector<PinnedVertex> pins;
    if (!binds(pin.region, region)) return pins;
    for (std::size_t v = 0; v < region.source_vertices.size(); ++v) {
        if (region.source_vertices[v] == pin.vertex)
            pins.push_back({static_cast<Index>(v), pin.at});
    }
    return pins;
}

std::vector<PinnedVertex> pinned_vertices(const Region& region,
                                          const std::vector<Constraint>& constraints) {
    std::vector<PinnedVertex> pins;
    for (const Constraint& constraint : constraints) {
        const Pin* pin = std::get_if<Pin>(&constraint.demand);
        if (pin == nullptr) continue;
        for (const PinnedVertex& pinned : pinned_vertices(region, *pin)) pins.push_back(pinned);
    }
    return pins;
}

void move_to_pins(const std::vector<PinnedVertex>& pins, Points2& uv) {
    if (pins.empty()) return;
    Vec2 from = Vec2::Zero(), to = Vec2::Zero();
    for (const PinnedVertex& pin : pins) {
        from += uv[static_cast<std::size_t>(pin.vertex)];
        to += pin.at;
    }
    from /= static_cast<double>(pins.size());
    to /= static_cast<double>(pins.size());
    double cosine = 0.0, sine = 0.0;
    for (const PinnedVertex& pin : pins) {
        const Vec2 a = uv[static_cast<std::size_t>(pin.vertex)] - from, b = pin.at - to;
        cosine += a.dot(b);
        sine += cross(a, b);
    }
    const double length = std::hypot(cosine, sine);
    const Vec2 turn = length > 0.0 ? Vec2(cosine / length, sine / length) : Vec2::UnitX();
    for (Vec2& p : uv) {
        const Vec2 q = p - from;
        p = to + Vec2(turn.x() * q.x() - turn.y() * q.y(), turn.y() * q.x() + turn.x() * q.y());
    }
}

}  // namespace lastflat
