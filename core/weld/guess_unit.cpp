#include "core/weld/guess_unit.h"

#include <Eigen/Geometry>
#include <array>

#include "core/text.h"

namespace lastflat {
namespace {

/// Of the vertices that triangles use, along the longest side of the box around them.
double length_of(const RawMesh& raw) {
    Eigen::AlignedBox3d box;
    for (const Triangle& triangle : raw.triangles) {
        for (const Index v : triangle) box.extend(raw.positions[static_cast<std::size_t>(v)]);
    }
    return box.isEmpty() ? 0.0 : box.sizes().maxCoeff();
}

}  // namespace

UnitGuess guess_unit(const RawMesh& raw) {
    const double length = length_of(raw);
    const auto is_last = [&](double unit) {
        return unit * length >= shortest_last_mm && unit * length <= longest_last_mm;
    };
    if (raw.triangles.size() < fewest_triangles_of_a_last || is_last(raw.default_unit_mm))
        return {raw.default_unit_mm, std::nullopt};
    constexpr std::array<std::pair<const char*, double>, 4> units{
        {{"mm", 1.0}, {"cm", 10.0}, {"m", 1000.0}, {"in", 25.4}}};
    for (const auto& [name, unit] : units) {
        if (!is_last(unit)) continue;
        return {unit, Warning{"unit_assumed",
                              "the request gives no units; the model is " +
                                  general_text(length, 4) + " units long, so they were taken as " +
                                  name + " (" + general_text(unit * length, 4) + " mm)",
                              std::nullopt}};
    }
    return {raw.default_unit_mm,
            Warning{"size_unusual",
                    "the model is " + general_text(raw.default_unit_mm * length, 4) +
                        " mm long if its units are those of its format; a last is 150 to 350 mm "
                        "long, and no unit makes it so",
                    std::nullopt}};
}

}  // namespace lastflat
