#include "core/sample/last_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace lastflat {

namespace {

// All measures below are those of a flat last of size 42: no heel, no toe spring. mm.
constexpr double base_size = 42.0;
constexpr double paris_point = 20.0 / 3.0;  // two thirds of a centimetre
constexpr double girth_per_size = 5.0;
constexpr double base_girth = 270.5;    // around the ball, square to the foot
constexpr double back_allowance = 5.0;  // the back curve stands behind the feather edge
constexpr double base_length = base_size * paris_point - back_allowance;
constexpr double sole_rounding_42 = 4.0;
constexpr double medial_arch_42 = 4.0;
constexpr double inward_swing_42 = 7.0;  // of the toe point, towards the big toe

/// Seat, waist and joint of the feather edge. The lateral joint lies further back and swells more;
/// the medial side is drawn in at the waist, under the arch.
const Points2 lateral_rear = {{0, 0},     {6.5, -18},   {25, -31}, {60, -37},
                              {105, -43}, {140, -52.5}, {170, -60}};
const Points2 medial_rear = {{0, 0},   {6.5, 17.5}, {25, 29.5},  {58, 32},
                             {95, 27}, {122, 25},   {150, 30.5}, {178, 38.5}};

/// The toe end of the feather edge: what is asked for as a toe shape.
Points2 toe_stations(ToeShape toe, Side side) {
    const bool lateral = side == Side::lateral;
    switch (toe) {
        case ToeShape::almond:
            return lateral ? Points2{{200, -57}, {228, -45.5}, {252, -30.5}, {268.5, -15}, {275, 0}}
                           : Points2{{204, 39}, {230, 33.5}, {253, 23.5}, {269, 11.5}, {275, 0}};
        case ToeShape::pointed:
            return lateral ? Points2{{200, -54}, {228, -39.5}, {252, -24}, {269, -11}, {275, 0}}
                           : Points2{{204, 37}, {230, 30}, {253, 20.5}, {269.5, 9.5}, {275, 0}};
        case ToeShape::square:
            return lateral ? Points2{{200, -59}, {228, -52}, {253, -41}, {270.5, -25}, {275, 0}}
                           : Points2{{204, 40.5}, {230, 38.5}, {255, 33}, {271, 21}, {275, 0}};
        case ToeShape::round: break;
    }
    return lateral ? Points2{{200, -59}, {228, -50.5}, {252, -37}, {269, -19.5}, {275, 0}}
                   : Points2{{204, 40}, {230, 36}, {254, 28}, {269.5, 16}, {275, 0}};
}

const Points2 lateral_top = {{7, 0},      {12, -7},    {28, -11.5}, {60, -13.5},
                             {94, -11.5}, {111, -6.5}, {117, 0}};
const Points2 medial_top = {{7, 0}, {12, 7}, {28, 12}, {60, 15}, {94, 13.5}, {111, 7.5}, {117, 0}};

/// The wall between feather edge and top, at stations along the half featherline. Each of the five
/// inner controls has a share of the way inwards (plan view), a bulge outwards and a height.
struct WallStation {
    double fraction;
    std::array<double, 5> inward;
    std::array<double, 5> bulge;
    std::array<double, 5> height;
};

const std::vector<WallStation> lateral_wall = {
    {0.00, {0.05, 0.15, 0.35, 0.60, 0.82}, {5.5, 7.5, 8.0, 5.5, 2.0}, {9, 22, 37, 51, 63}},
    {0.12, {0.03, 0.13, 0.36, 0.64, 0.87}, {5.0, 6.5, 5.0, 2.5, 0.5}, {9, 22, 37, 50, 62}},
    {0.30, {0.02, 0.13, 0.39, 0.70, 0.90}, {4.5, 5.0, 2.0, 0.0, 0.0}, {10, 23, 37, 51, 64}},
    {0.50, {0.02, 0.15, 0.41, 0.70, 0.88}, {4.5, 4.5, 1.0, 0.0, 0.0}, {11, 24, 37, 53, 70}},
    {0.70, {0.01, 0.12, 0.34, 0.59, 0.81}, {4.5, 3.5, 0.5, 0.0, 0.0}, {12, 25, 34, 50, 73}},
    {0.86, {0.01, 0.08, 0.29, 0.52, 0.76}, {3.5, 3.0, 0.5, 0.0, 0.0}, {13, 25, 28, 42, 72}},
    {1.00, {0.00, 0.06, 0.28, 0.50, 0.73}, {1.5, 1.5, 0.0, 0.0, 0.0}, {13, 27, 27, 36, 70}},
};
const std::vector<WallStation> medial_wall = {
    {0.00, {0.05, 0.15, 0.35, 0.60, 0.82}, {5.5, 7.5, 8.0, 5.5, 2.0}, {9, 22, 37, 51, 63}},
    {0.12, {0.03, 0.12, 0.34, 0.62, 0.86}, {5.0, 6.0, 4.5, 2.0, 0.5}, {9, 22, 37, 50, 62}},
    {0.30, {0.02, 0.10, 0.32, 0.64, 0.88}, {4.5, 6.0, 3.5, 0.5, 0.0}, {11, 25, 39, 53, 65}},
    {0.50, {0.02, 0.10, 0.31, 0.59, 0.84}, {5.5, 7.5, 5.0, 1.5, 0.0}, {12, 28, 44, 60, 73}},
    {0.70, {0.01, 0.11, 0.31, 0.55, 0.79}, {4.5, 4.0, 2.0, 1.0, 0.0}, {12, 27, 38, 55, 76}},
    {0.86, {0.01, 0.08, 0.28, 0.51, 0.75}, {3.0, 3.0, 1.0, 0.0, 0.0}, {13, 26, 31, 45, 74}},
    {1.00, {0.00, 0.06, 0.28, 0.50, 0.73}, {1.5, 1.5, 0.0, 0.0, 0.0}, {13, 27, 27, 36, 70}},
};
constexpr double top_height_back = 76.0;
constexpr double top_height_front = 99.0;

/// One measure of one inner control along the half, level at both ends so that the two halves meet
/// smoothly in the back curve and in the centre front.
template <typename Measure>
double along_wall(const std::vector<WallStation>& stations, double fraction, Measure measure) {
    std::vector<double> knots, values;
    for (const WallStation& station : stations) {
        knots.push_back(station.fraction);
        values.push_back(measure(station));
    }
    return CubicSpline(std::move(knots), std::move(values), SplineEnd::level)(fraction);
}

/// The stations of half an outline, with lengths graded by length and widths by girth.
Points2 graded(Points2 stations, double length_scale, double girth_scale) {
    for (Vec2& station : stations) {
        station.x() *= length_scale;
        station.y() *= girth_scale;
    }
    return stations;
}

Points2 feather_stations(ToeShape toe, Side side) {
    Points2 stations = side == Side::lateral ? lateral_rear : medial_rear;
    const Points2 toe_end = toe_stations(toe, side);
    stations.insert(stations.end(), toe_end.begin(), toe_end.end());
    return stations;
}

/// Chord lengths: the parameter in which a spline through uneven points does not overshoot.
std::vector<double> chord_knots(const Points2& points) {
    std::vector<double> knots = {0.0};
    for (std::size_t i = 1; i < points.size(); ++i) {
        knots.push_back(knots.back() + (points[i] - points[i - 1]).norm());
    }
    return knots;
}

std::vector<double> coordinates(const Points2& points, Eigen::Index axis) {
    std::vector<double> values;
    for (const Vec2& point : points) values.push_back(point[axis]);
    return values;
}

/// The share of the steepest slope that the bottom has between seat and ball.
double rear_profile(double fraction) {
    constexpr double seat = 0.5;  // the seat is less steep than the shank
    return (seat + (1.0 - seat) * smooth_step((fraction - 0.08) / 0.30)) *
           (1.0 - smooth_step((fraction - 0.36) / 0.34));
}

/// The share of the steepest slope that the bottom has between ball and toe.
double toe_profile(double fraction) {
    return smooth_step((fraction - 0.58) / 0.55);
}

/// Simpson's rule; the integrands are smooth, so the error is far below the rounding of vertices.
template <typename Function>
double integral(Function function, double from, double to) {
    constexpr int intervals = 64;
    const double step = (to - from) / intervals;
    double sum = function(from) + function(to);
    for (int i = 1; i < intervals; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * function(from + i * step);
    return sum * step / 3.0;
}

constexpr int outline_samples = 512;

}  // namespace

HalfOutline::HalfOutline(const Points2& stations)
    : x_(chord_knots(stations), coordinates(stations, 0), SplineEnd::level),
      y_(chord_knots(stations), coordinates(stations, 1), SplineEnd::straight),
      end_(chord_knots(stations).back()),
      lengths_({0.0}) {
    Vec2 last(x_(0.0), y_(0.0));
    for (int i = 1; i <= outline_samples; ++i) {
        const double parameter = end_ * i / outline_samples;
        const Vec2 next(x_(parameter), y_(parameter));
        lengths_.push_back(lengths_.back() + (next - last).norm());
        last = next;
    }
}

double HalfOutline::parameter(double fraction) const {
    const double length = std::clamp(fraction, 0.0, 1.0) * lengths_.back();
    const auto next = std::upper_bound(lengths_.begin() + 1, lengths_.end() - 1, length);
    const auto i = static_cast<std::size_t>(next - lengths_.begin()) - 1;
    const double within = (length - lengths_[i]) / (lengths_[i + 1] - lengths_[i]);
    return end_ * (static_cast<double>(i) + within) / outline_samples;
}

Vec2 HalfOutline::at(double fraction) const {
    const double t = parameter(fraction);
    return {x_(t), y_(t)};
}

Vec2 HalfOutline::tangent(double fraction) const {
    // At the ends the outline crosses the centre line at a right angle.
    if (fraction <= 0.0) return Vec2(0.0, y_(1e-3 * end_)).normalized();
    if (fraction >= 1.0) return Vec2(0.0, -y_((1.0 - 1e-3) * end_)).normalized();
    constexpr double step = 1e-4;
    return (at(fraction + step) - at(fraction - step)).normalized();
}

BottomBend::BottomBend(double length, double heel_height, double toe_spring)
    : length_(length),
      heel_height_(heel_height),
      rear_slope_(heel_height / (length * integral(rear_profile, 0.0, 1.0))),
      toe_slope_(toe_spring / (length * integral(toe_profile, 0.0, 1.0))) {}

double BottomBend::slope(double fraction) const {
    return toe_slope_ * toe_profile(fraction) - rear_slope_ * rear_profile(fraction);
}

Vec3 BottomBend::operator()(const Vec3& flat) const {
    const double fraction = flat.x() / length_;
    const auto rise = [this](double p) { return slope(p); };
    const auto run = [this](double p) { return std::sqrt(1.0 - slope(p) * slope(p)); };
    const double x = length_ * integral(run, 0.0, fraction);
    const double z = heel_height_ + length_ * integral(rise, 0.0, fraction);
    // What stands on the bottom turns with it; the rear turns as one piece, by a part of the angle
    // of the shank, as the leg over a raised heel does.
    constexpr double rear_turn = 0.28;
    const double sine = rear_turn * rear_slope_ * (1.0 - smooth_step((fraction - 0.35) / 0.40)) -
                        toe_slope_ * toe_profile(fraction);
    const double cosine = std::sqrt(1.0 - sine * sine);
    return {x + sine * flat.z(), flat.y(), z + cosine * flat.z()};
}

LastShape::LastShape(const SampleLastOptions& options)
    : length_scale_((options.size_eu * paris_point - back_allowance) / base_length),
      girth_scale_(
          (base_girth + girth_per_size * (options.size_eu - base_size) + options.extra_girth_mm) /
          base_girth),
      feather_lateral_(
          graded(feather_stations(options.toe, Side::lateral), length_scale_, girth_scale_)),
      feather_medial_(
          graded(feather_stations(options.toe, Side::medial), length_scale_, girth_scale_)),
      top_lateral_(graded(lateral_top, length_scale_, girth_scale_)),
      top_medial_(graded(medial_top, length_scale_, girth_scale_)),
      bend_(base_length * length_scale_, options.heel_height_mm, options.toe_spring_mm),
      top_back_(bent_wall(Side::lateral, 0.0).back()),
      top_front_(bent_wall(Side::lateral, 1.0).back()) {}

WallControls LastShape::bent_wall(Side side, double fraction) const {
    const bool lateral = side == Side::lateral;
    const HalfOutline& feather = lateral ? feather_lateral_ : feather_medial_;
    const HalfOutline& top = lateral ? top_lateral_ : top_medial_;
    const std::vector<WallStation>& stations = lateral ? lateral_wall : medial_wall;
    const Vec2 foot = feather.at(fraction);
    const Vec2 head = top.at(fraction);
    const Vec2 along = feather.tangent(fraction);
    const Vec2 outward = lateral ? Vec2(along.y(), -along.x()) : Vec2(-along.y(), along.x());
    // The arch lifts the medial feather edge between seat and ball.
    const double arch = lateral ? 0.0
                                : medial_arch_42 * smooth_step((fraction - 0.16) / 0.24) *
                                      (1.0 - smooth_step((fraction - 0.42) / 0.26));
    WallControls controls;
    controls.front() = Vec3(foot.x(), foot.y(), girth_scale_ * arch);
    for (std::size_t k = 0; k < 5; ++k) {
        const auto inward = [k](const WallStation& s) { return s.inward[k]; };
        const auto bulge = [k](const WallStation& s) { return s.bulge[k]; };
        const auto height = [k](const WallStation& s) { return s.height[k]; };
        const double share = along_wall(stations, fraction, inward);
        const Vec2 plan = (1.0 - share) * foot + share * head +
                          girth_scale_ * along_wall(stations, fraction, bulge) * outward;
        // The lift of the arch fades out towards the top.
        const double lift = arch * (1.0 - 0.25 * static_cast<double>(k));
        const double z = along_wall(stations, fraction, height) + lift;
        controls[k + 1] = Vec3(plan.x(), plan.y(), girth_scale_ * z);
    }
    const double back = top_lateral_.at(0.0).x();
    const double forward = (head.x() - back) / (top_lateral_.at(1.0).x() - back);
    const double top_height = top_height_back + (top_height_front - top_height_back) * forward;
    controls.back() = Vec3(head.x(), head.y(), girth_scale_ * top_height);
    for (Vec3& control : controls) {
        // The foot's axis swings inwards in front of the heel, so the lateral side is the rounder.
        const double forward_share = control.x() / (base_length * length_scale_);
        control.y() += girth_scale_ * inward_swing_42 * smooth_step((forward_share - 0.2) / 0.95);
        control = bend_(control);
    }
    return controls;
}

WallControls LastShape::wall(Side side, double fraction) const {
    WallControls controls = bent_wall(side, fraction);
    // The top is sawn flat: every wall ends in the plane through the back and the front of the top.
    Vec3& end = controls.back();
    const double share = (end.x() - top_back_.x()) / (top_front_.x() - top_back_.x());
    const double drop = end.z() - (top_back_.z() + share * (top_front_.z() - top_back_.z()));
    end.z() -= drop;
    // Half the correction one control below keeps the wall smooth just under the edge.
    controls[wall_controls - 2].z() -= 0.5 * drop;
    return controls;
}

double LastShape::sole_rounding() const {
    return girth_scale_ * sole_rounding_42;
}

}  // namespace lastflat
