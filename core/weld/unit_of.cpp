#include "core/weld/unit_of.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

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

constexpr std::array<std::pair<const char*, double>, 4> units{
    {{"mm", 1.0}, {"cm", 10.0}, {"m", 1000.0}, {"in", 25.4}}};

std::string mm_text(double length) {
    constexpr double long_mm = 1000.0;  // and more is no last: its tenths say nothing
    return length < long_mm ? general_text(length, 4) : fixed_text(length, 0);
}

UnitGuess given_unit(double unit, double length, const WeldOptions& options, bool is_piece) {
    constexpr double alike = 0.05;
    if (options.last_length_mm &&
        std::abs(unit * length - *options.last_length_mm) > alike * *options.last_length_mm)
        throw Error(ErrorCode::unsupported_request,
                    "the model is " + mm_text(unit * length) + " mm long in its units, not " +
                        general_text(*options.last_length_mm, 4) +
                        "; leave the units out, or correct one of them")
            .at_option({"last_length_mm"});
    const bool usual = unit * length >= shortest_infant_mm && unit * length <= longest_last_mm;
    if (is_piece || usual || options.last_length_mm) return {unit, std::nullopt};
    return {unit,
            Warning{"size_unusual",
                    "the model is " + mm_text(unit * length) +
                        " mm long in the units that the request gives; a last is 95 to 350 mm "
                        "long",
                    std::nullopt}};
}

UnitGuess unit_by_length(double length, double wanted) {
    constexpr double alike = 0.01;
    for (const auto& [name, unit] : units) {
        if (std::abs(unit * length - wanted) <= alike * wanted) return {unit, std::nullopt};
    }
    return {wanted / length,
            Warning{"unit_assumed",
                    "the model is " + general_text(length, 4) + " units long; one is taken as " +
                        general_text(wanted / length, 6) + " mm, so that the last is " +
                        general_text(wanted, 6) + " mm long",
                    std::nullopt}};
}

}  // namespace

UnitGuess unit_of(const RawMesh& raw, const WeldOptions& options) {
    const double length = length_of(raw);
    const bool is_piece = raw.triangles.size() < fewest_triangles_of_a_last;
    if (options.unit_mm) return given_unit(*options.unit_mm, length, options, is_piece);
    if (options.last_length_mm && length > 0.0)
        return unit_by_length(length, *options.last_length_mm);
    const auto is_last = [&](double unit) {
        return unit * length >= shortest_last_mm && unit * length <= longest_last_mm;
    };
    if (is_piece || is_last(raw.default_unit_mm)) return {raw.default_unit_mm, std::nullopt};
    for (const auto& [name, unit] : units) {
        if (!is_last(unit)) continue;
        return {unit, Warning{"unit_assumed",
                              "the request gives no units; the model is " +
                                  general_text(length, 4) + " units long, so they were taken as " +
                                  name + " (" + mm_text(unit * length) + " mm)",
                              std::nullopt}};
    }
    return {raw.default_unit_mm,
            Warning{"size_unusual",
                    "the model is " + mm_text(raw.default_unit_mm * length) +
                        " mm long if its units are those of its format; a last is 150 to 350 mm "
                        "long, and no unit makes it so",
                    std::nullopt}};
}

}  // namespace lastflat
