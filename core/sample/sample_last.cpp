#include "core/sample/sample_last.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <utility>

#include "core/error.h"
#include "core/sample/last_shape.h"

namespace lastflat {

namespace {

constexpr Index columns = 128;  // around the upper, column 0 at the back
constexpr Index rows = 32;      // rings of the upper above the feather edge
constexpr Index front_column = columns / 2;
// The sole and the top are grids whose border is a ring of the upper: no fan of slivers at the
// ends.
constexpr Index across = 8;
constexpr Index along = columns / 2 - across;

enum Label : std::uint32_t { upper_label, sole_label, top_label };

void check_range(const char* option, double value, double low, double high) {
    if (value >= low && value <= high) return;
    std::ostringstream detail;
    detail << option << " is " << value << "; a sample last is made for " << low << " to " << high;
    throw Error(ErrorCode::unsupported_request, detail.str()).at_option({option});
}

void check(const SampleLastOptions& options) {
    check_range("size_eu", options.size_eu, 30.0, 50.0);
    check_range("heel_height_mm", options.heel_height_mm, 0.0, 80.0);
    check_range("toe_spring_mm", options.toe_spring_mm, 0.0, 25.0);
    check_range("extra_girth_mm", options.extra_girth_mm, -15.0, 15.0);
}

/// To 1e-4 mm; adding zero turns a negative zero into a plain one.
Vec3 rounded(const Vec3& point) {
    constexpr double steps_per_mm = 1e4;
    return Vec3(std::round(point.x() * steps_per_mm) / steps_per_mm + 0.0,
                std::round(point.y() * steps_per_mm) / steps_per_mm + 0.0,
                std::round(point.z() * steps_per_mm) / steps_per_mm + 0.0);
}

/// Points on a wall curve, nearly evenly spaced from the feather edge to the top.
Points3 evenly_spaced(const WallControls& controls) {
    constexpr int samples = 400;
    std::vector<double> lengths = {0.0};
    Vec3 last = controls.front();
    for (int i = 1; i <= samples; ++i) {
        const Vec3 next = wall_point(controls, static_cast<double>(i) / samples);
        lengths.push_back(lengths.back() + (next - last).norm());
        last = next;
    }
    Points3 points;
    std::size_t i = 0;
    for (Index row = 0; row <= rows; ++row) {
        // Rings lie closer at the feather edge, where the wall turns over the toe.
        const double share = static_cast<double>(row) / rows;
        const double length = lengths.back() * share * (0.85 + 0.15 * share);
        while (i + 2 < lengths.size() && lengths[i + 1] < length) ++i;
        const double within = (length - lengths[i]) / (lengths[i + 1] - lengths[i]);
        points.push_back(wall_point(controls, (static_cast<double>(i) + within) / samples));
    }
    return points;
}

Index upper_vertex(Index row, Index column) {
    return row * columns + (column + columns) % columns;
}

Points3 upper_positions(const LastShape& shape) {
    Points3 positions(static_cast<std::size_t>((rows + 1) * columns));
    for (Index column = 0; column < columns; ++column) {
        const bool lateral = column <= front_column;
        const Index from_back = lateral ? column : columns - column;
        const double fraction = static_cast<double>(from_back) / front_column;
        const Points3 points =
            evenly_spaced(shape.wall(lateral ? Side::lateral : Side::medial, fraction));
        for (Index row = 0; row <= rows; ++row) {
            positions[static_cast<std::size_t>(upper_vertex(row, column))] =
                rounded(points[static_cast<std::size_t>(row)]);
        }
    }
    return positions;
}

/// The square of the sine of the smallest angle, whose order is that of the smallest angle; zero
/// for a triangle without area.
double sharpness(const Points3& positions, const Triangle& triangle) {
    const Vec3& a = positions[static_cast<std::size_t>(triangle[0])];
    const Vec3& b = positions[static_cast<std::size_t>(triangle[1])];
    const Vec3& c = positions[static_cast<std::size_t>(triangle[2])];
    const double twice_area_squared = (b - a).cross(c - a).squaredNorm();
    std::array<double, 3> sides = {(b - a).squaredNorm(), (c - b).squaredNorm(),
                                   (a - c).squaredNorm()};
    std::sort(sides.begin(), sides.end());
    return twice_area_squared / (sides[1] * sides[2]);  // the smallest angle lies between the two
}

/// Splits a quad, given counter-clockwise, along the diagonal that leaves the wider angles.
void add_quad(RawMesh& mesh, const std::array<Index, 4>& q, Label label) {
    const std::array<Triangle, 2> first = {{{q[0], q[1], q[2]}, {q[0], q[2], q[3]}}};
    const std::array<Triangle, 2> second = {{{q[0], q[1], q[3]}, {q[1], q[2], q[3]}}};
    const auto worst = [&mesh](const std::array<Triangle, 2>& pair) {
        return std::min(sharpness(mesh.positions, pair[0]), sharpness(mesh.positions, pair[1]));
    };
    const auto& pair = worst(second) > worst(first) ? second : first;
    mesh.triangles.insert(mesh.triangles.end(), pair.begin(), pair.end());
    mesh.triangle_labels.insert(mesh.triangle_labels.end(), 2, label);
}

void add_upper(RawMesh& mesh, const LastShape& shape) {
    mesh.positions = upper_positions(shape);
    for (Index row = 0; row < rows; ++row) {
        for (Index column = 0; column < columns; ++column) {
            add_quad(mesh,
                     {upper_vertex(row, column), upper_vertex(row, column + 1),
                      upper_vertex(row + 1, column + 1), upper_vertex(row + 1, column)},
                     upper_label);
        }
    }
}

/// The column of the upper that a border vertex of a grid falls on: `i` runs from back to front,
/// `j` from lateral to medial; each corner lies half the grid's width beside the back or the front.
Index border_column(Index i, Index j) {
    if (j == 0) return across / 2 + i;
    if (i == along) return across / 2 + along + j;
    if (j == across) return across / 2 + 2 * along + across - i;
    return across / 2 - j;  // i == 0
}

/// A grid spanned by a ring of the upper, sagging by `sag` mm in the middle of its width.
class RingGrid {
public:
    RingGrid(RawMesh& mesh, Index ring_row, double sag)
        : ring_row_(ring_row), first_(static_cast<Index>(mesh.positions.size())) {
        for (Index i = 1; i < along; ++i) {
            for (Index j = 1; j < across; ++j) {
                Vec3 point = spanned(mesh.positions, i, j);
                // A parabola across, and nearly even along, down to nothing at the two ends.
                const double u = 2.0 * i / along - 1.0, v = 2.0 * j / across - 1.0;
                const double u_sixth = u * u * u * u * u * u;
                point.z() -= sag * (1.0 - u_sixth) * (1.0 - v * v);
                mesh.positions.push_back(rounded(point));
            }
        }
    }

    [[nodiscard]] Index vertex(Index i, Index j) const {
        const bool inner = i > 0 && i < along && j > 0 && j < across;
        return inner ? first_ + (i - 1) * (across - 1) + (j - 1)
                     : upper_vertex(ring_row_, border_column(i, j));
    }

private:
    /// Coons' patch: the two rulings between opposite sides, less the bilinear part they share.
    [[nodiscard]] Vec3 spanned(const Points3& positions, Index i, Index j) const {
        const auto at = [&](Index k, Index l) -> const Vec3& {
            return positions[static_cast<std::size_t>(vertex(k, l))];
        };
        const double u = static_cast<double>(i) / along, v = static_cast<double>(j) / across;
        const Vec3 lengthwise = (1.0 - u) * at(0, j) + u * at(along, j);
        const Vec3 crosswise = (1.0 - v) * at(i, 0) + v * at(i, across);
        const Vec3 shared = (1.0 - u) * ((1.0 - v) * at(0, 0) + v * at(0, across)) +
                            u * ((1.0 - v) * at(along, 0) + v * at(along, across));
        return lengthwise + crosswise - shared;
    }

    Index ring_row_;
    Index first_;
};

void add_grid(RawMesh& mesh, Index ring_row, double sag, Label label) {
    const RingGrid grid(mesh, ring_row, sag);
    for (Index i = 0; i < along; ++i) {
        for (Index j = 0; j < across; ++j) {
            std::array<Index, 4> quad = {grid.vertex(i, j), grid.vertex(i + 1, j),
                                         grid.vertex(i + 1, j + 1), grid.vertex(i, j + 1)};
            if (label == sole_label) std::reverse(quad.begin(), quad.end());  // it faces down
            add_quad(mesh, quad, label);
        }
    }
}

std::vector<Index> column_path(Index column) {
    std::vector<Index> path;
    for (Index row = 0; row <= rows; ++row) path.push_back(upper_vertex(row, column));
    return path;
}

std::vector<Index> ring_path(Index row) {
    std::vector<Index> path;
    for (Index column = 0; column <= columns; ++column) path.push_back(upper_vertex(row, column));
    return path;
}

}  // namespace

SampleLast make_sample_last(const SampleLastOptions& options) {
    check(options);
    const LastShape shape(options);
    SampleLast last;
    last.mesh.label_sets = {{"upper"}, {"sole"}, {"top"}};
    add_upper(last.mesh, shape);
    add_grid(last.mesh, 0, shape.sole_rounding(), sole_label);
    add_grid(last.mesh, rows, 0.0, top_label);
    last.curves = {{curve_name::centre_front, column_path(front_column)},
                   {curve_name::heel, column_path(0)},
                   {curve_name::featherline, ring_path(0)},
                   {curve_name::topline, ring_path(rows)}};
    last.lateral_vertex = upper_vertex(rows / 2, columns / 4);
    last.medial_vertex = upper_vertex(rows / 2, columns - columns / 4);
    return last;
}

}  // namespace lastflat
