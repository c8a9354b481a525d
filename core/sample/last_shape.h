// The form of the last, before it is a mesh: two outlines, a wall between them, a bent bottom.
#pragma once

#include "core/sample/sample_last.h"
#include "core/sample/spline.h"

namespace lastflat {

enum class Side { lateral, medial };

/// One half of a closed outline seen from above, from its back end to its front end on the centre
/// line; points on it are told by the fraction of its length.
class HalfOutline {
public:
    /// In: points from back to front, the first and the last with y = 0.
    explicit HalfOutline(const Points2& stations);

    /// In: `fraction` of the length, 0 at the back, 1 at the front.
    [[nodiscard]] Vec2 at(double fraction) const;

    /// The unit tangent towards the front.
    [[nodiscard]] Vec2 tangent(double fraction) const;

private:
    [[nodiscard]] double parameter(double fraction) const;

    CubicSpline x_;
    CubicSpline y_;
    double end_ = 0.0;             ///< the parameter at the front
    std::vector<double> lengths_;  ///< from the back to equally spaced parameters
};

/// The bottom in side view: a line as long as the foot, bent up to the seat and up to the toe.
class BottomBend {
public:
    BottomBend(double length, double heel_height, double toe_spring);

    /// Where a point of the flat last goes.
    [[nodiscard]] Vec3 operator()(const Vec3& flat) const;

private:
    [[nodiscard]] double slope(double fraction) const;

    double length_;
    double heel_height_;
    double rear_slope_;  ///< sine of the steepest angle of the shank
    double toe_slope_;   ///< sine of the steepest angle of the toe
};

/// The whole form: `wall` of any side and fraction gives the wall curve from feather edge to top.
class LastShape {
public:
    explicit LastShape(const SampleLastOptions& options);

    /// The control points of the wall curve that leaves the feather edge at `fraction` of the way
    /// from back to toe. Their first points form the feather edge, their last ones lie in a plane.
    [[nodiscard]] WallControls wall(Side side, double fraction) const;

    /// How far the sole hangs below its border, at the middle of its width. mm.
    [[nodiscard]] double sole_rounding() const;

private:
    [[nodiscard]] WallControls bent_wall(Side side, double fraction) const;

    double length_scale_;
    double girth_scale_;
    HalfOutline feather_lateral_;
    HalfOutline feather_medial_;
    HalfOutline top_lateral_;
    HalfOutline top_medial_;
    BottomBend bend_;
    Vec3 top_back_;  ///< the two ends of the top plane on the centre line
    Vec3 top_front_;
};

}  // namespace lastflat
