#include "core/landmarks/check_outcome.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <optional>
#include <string>

#include "core/numerics/geometry.h"
#include "core/text.h"

namespace lastflat {
namespace {

/// Between what two numbers a ratio lies on a last: from an infant's to a high-heeled pump's.
struct Bounds {
    double least, most;

    [[nodiscard]] bool hold(double value) const { return value >= least && value <= most; }
};
constexpr Bounds width_to_length{0.2, 0.6};
constexpr Bounds instep_to_length{0.3, 1.1}, heel_to_length{0.1, 0.8};
constexpr Bounds top_along{-0.15, 0.55}, top_above{0.1, 1.0};
constexpr double facing_down = 0.7;
/// A way along the line of this share of the last's length that is so many times longer than
/// straight goes into a notch or a hole, and out again.
constexpr double notch_way = 0.05, notch_detour = 2.0;
/// Of the length: so near to the topline a line of the middle must end.
constexpr double end_reach = 0.06;

Vec3 middle_of(const Points3& line) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& p : line) sum += p;
    return sum / static_cast<double>(line.size());
}

double extent(const Points3& line, const Vec3& direction) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const Vec3& p : line) {
        least = std::min(least, direction.dot(p));
        most = std::max(most, direction.dot(p));
    }
    return most - least;
}

/// Where a line goes a long way to a point that is near.
std::optional<Vec3> notch_in(const Points3& line, double least_way) {
    constexpr std::size_t most_looked_at = 400;
    const std::size_t step = line.size() / most_looked_at + 1;
    std::vector<double> along{0.0};
    for (std::size_t i = 1; i < line.size(); ++i)
        along.push_back(along.back() + (line[i] - line[i - 1]).norm());
    for (std::size_t i = 0; i < line.size(); i += step) {
        for (std::size_t j = i + 1; j < line.size(); j += step) {
            const double way = along[j] - along[i];
            if (way >= least_way && way > notch_detour * (line[j] - line[i]).norm())
                return line[(i + j) / 2];
        }
    }
    return std::nullopt;
}

void check_middle_line(const Points3& line, const std::string& name, Bounds ratio,
                       const Points3& topline, double length) {
    if (distance_to_line(topline, line.back()) > end_reach * length)
        fail_search("the " + name +
                    " line found does not reach the topline, but is interrupted at " +
                    position_text(line.back()) +
                    ", where something may stand out of the last (a lug, a pin); take it off");
    if (const auto notch = notch_in(line, notch_way * length))
        fail_search("the " + name + " line found runs into a notch or a hole at " +
                    position_text(*notch) + "; fill it");
    if (!ratio.hold(length_of(line) / length))
        fail_search("the " + name + " line found would be " + fixed_text(length_of(line), 0) +
                    " mm long on a last of " + fixed_text(length, 0) + " mm");
}

}  // namespace

void check_outcome(const std::vector<BareFace>& faces, const SoleAndTop& parts,
                   const Points3& featherline, const Points3& topline, const Landmarks& found) {
    Vec3 sole = Vec3::Zero();
    for (std::size_t f = 0; f < faces.size(); ++f) {
        if (parts.sole[f]) sole += faces[f].area * faces[f].normal;
    }
    if (sole.normalized().dot(found.up) > -facing_down)
        fail_search("the sole found does not lie below the rest");
    const double length = (found.toe_point - found.heel_point).norm();
    const Vec3 top = middle_of(topline) - found.heel_point;
    if (!top_along.hold(top.dot(found.forward) / length) ||
        !top_above.hold(top.dot(found.up) / length))
        fail_search("the top found does not lie above the heel, but by " +
                    position_text(middle_of(topline)));
    if (!width_to_length.hold(extent(featherline, found.up.cross(found.forward)) / length))
        fail_search("the sole found has not the width of one");
    for (const CurveSource& curve : found.curves) {
        const bool front = curve.name == curve_name::centre_front;
        if (!front && curve.name != curve_name::heel) continue;
        check_middle_line(std::get<Polyline>(curve.form).points, curve.name,
                          front ? instep_to_length : heel_to_length, topline, length);
    }
}

}  // namespace lastflat
