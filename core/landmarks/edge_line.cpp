#include "core/landmarks/edge_line.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/landmarks/smooth_normals.h"
#include "core/numerics/geometry.h"

namespace lastflat {
namespace {

constexpr double small_gap = 5.0;  ///< mm on a last; a shorter stretch is not told from its sides

/// 1 for a last of the usual size in mm: its surface is about 70,000 mm^2.
double scale_of(const std::vector<BareFace>& faces) {
    double area = 0.0;
    for (const BareFace& face : faces) area += face.area;
    return std::sqrt(area / 70'000.0);
}

/// The bend of the surface over an edge; radians.
double bend(const SurfaceMesh& surface, const std::vector<BareFace>& faces,
            OpenMesh::HalfedgeHandle h) {
    const BareFace& a = faces[at(surface.mesh.face_handle(h).idx())];
    const BareFace& b = faces[at(surface.mesh.opposite_face_handle(h).idx())];
    return std::acos(std::clamp(a.normal.dot(b.normal), -1.0, 1.0));
}

/// The same where it is convex; else 0.
double ridge(const SurfaceMesh& surface, const std::vector<BareFace>& faces,
             OpenMesh::HalfedgeHandle h) {
    const BareFace& a = faces[at(surface.mesh.face_handle(h).idx())];
    const BareFace& b = faces[at(surface.mesh.opposite_face_handle(h).idx())];
    return a.normal.dot(b.centre - a.centre) > 0.0 ? 0.0 : bend(surface, faces, h);
}

/// Per edge of a line, whether it is sharp, and so for `least_run` mm at least.
std::vector<bool> sharp_edges(const SurfaceMesh& surface, const std::vector<BareFace>& faces,
                              const std::vector<Index>& line, double least_run) {
    const double least = std::max(0.26, 3.0 * typical_bend(surface, faces));  // radians
    std::vector<bool> sharp;
    std::vector<double> lengths;
    for (std::size_t i = 1; i < line.size(); ++i) {
        const auto h = surface.mesh.find_halfedge(OpenMesh::VertexHandle(line[i - 1]),
                                                  OpenMesh::VertexHandle(line[i]));
        sharp.push_back(bend(surface, faces, h) > least);
        lengths.push_back(surface.mesh.calc_edge_length(h));
    }
    const std::size_t n = sharp.size();
    const auto first = std::find(sharp.begin(), sharp.end(), false);
    if (first == sharp.end()) return sharp;
    const auto begin = static_cast<std::size_t>(first - sharp.begin());
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t end = k;
        double run = 0.0;
        for (; end < n && sharp[(begin + end) % n]; ++end) run += lengths[(begin + end) % n];
        for (; run < least_run && k < end; ++k) sharp[(begin + k) % n] = false;
        k = end;
    }
    return sharp;
}

/// Per edge of a line, whether it runs over the filling of a feature that was taken off, or along
/// it.
std::vector<bool> filled_edges(const SurfaceMesh& surface, const std::vector<Index>& line) {
    std::vector<bool> filled;
    for (std::size_t i = 1; i < line.size(); ++i) {
        const auto h = surface.mesh.find_halfedge(OpenMesh::VertexHandle(line[i - 1]),
                                                  OpenMesh::VertexHandle(line[i]));
        const Index left = surface.mesh.face_handle(h).idx();
        const Index right = surface.mesh.opposite_face_handle(h).idx();
        filled.push_back(std::any_of(
            surface.filled.begin(), surface.filled.end(),
            [&](const auto& feature) { return feature.holds(left) || feature.holds(right); }));
    }
    return filled;
}

/// The mean distance between the points of a closed line.
double spacing_of(const Points3& closed) {
    return length_of(closed) / static_cast<double>(closed.size() - 1);
}

/// Where there are no sharp edges, the line of a cut goes in steps along edges: evened out.
void even_out(Points3& closed, double over) {
    const double wanted = 2.0 * std::pow(over / spacing_of(closed), 2);
    const int rounds = static_cast<int>(std::clamp(wanted, 1.0, 200.0));
    closed.pop_back();
    const std::size_t n = closed.size();
    for (int round = 0; round < rounds; ++round) {
        const Points3 before = closed;
        for (std::size_t i = 0; i < n; ++i)
            closed[i] =
                0.25 * before[(i + n - 1) % n] + 0.5 * before[i] + 0.25 * before[(i + 1) % n];
    }
    closed.push_back(closed.front());
}

/// Whether the vertices lie to and fro beside the edge that they follow, as those of a scan do.
bool is_jagged(const Points3& closed, double over) {
    constexpr double most_longer = 1.02;  // than the same line evened out
    if (spacing_of(closed) > over) return false;
    Points3 even = closed;
    even_out(even, over);
    return length_of(closed) > most_longer * length_of(even);
}

/// A sharp line goes on from its end along edges that are still a little sharp and turn little.
void go_on(const SurfaceMesh& surface, const std::vector<BareFace>& faces, double most,
           std::vector<Index>& line) {
    constexpr double least_ridge = 0.09, least_ahead = 0.75;  // radians; cosine
    double length = 0.0;
    while (line.size() > 1 && length < most) {
        const Vec3 at = surface.position(line.back());
        const Vec3 ahead = (at - surface.position(line[line.size() - 2])).normalized();
        Index next = -1;
        double sharpest = least_ridge;
        for (const auto h : surface.mesh.voh_range(OpenMesh::VertexHandle(line.back()))) {
            const Index to = surface.mesh.to_vertex_handle(h).idx();
            if ((surface.position(to) - at).normalized().dot(ahead) < least_ahead) continue;
            if (ridge(surface, faces, h) <= sharpest) continue;
            sharpest = ridge(surface, faces, h);
            next = to;
        }
        if (next < 0) return;
        length += (surface.position(next) - at).norm();
        line.push_back(next);
    }
}

/// So long a line must be sharp to be told from its sides: some of its edges.
double least_run(const Points3& line, double scale) {
    constexpr double edges = 3.0;
    return std::max(small_gap * scale, edges * spacing_of(line));
}

Vec3 end_direction(const Points3& line, double way) {
    std::size_t at = line.size() - 1;
    while (at > 0 && (line.back() - line[at]).norm() < way) --at;
    return (line.back() - line[at]).normalized();
}

/// The cubic between the ends of two lines that goes on as they end; without its ends.
void bridge(const Points3& from, const Points3& to, double scale, Points3& result) {
    const Vec3 &a = from.back(), &b = to.back();
    const double span = (b - a).norm();
    const Vec3 leave = span * end_direction(from, 6.0 * scale),
               arrive = -span * end_direction(to, 6.0 * scale);
    const auto steps = static_cast<int>(std::max(2.0, std::ceil(span / (2.0 * scale))));
    for (int i = 1; i < steps; ++i) {
        const double t = static_cast<double>(i) / steps, u = 1.0 - t;
        result.push_back((1.0 + 2.0 * t) * u * u * a + t * u * u * leave +
                         t * t * (3.0 - 2.0 * t) * b - t * t * u * arrive);
    }
}

/// Where a sharp line fades out and comes back, a cut goes the shortest way between; a shoe-maker's
/// eye follows the last of the edge and then goes on as it went. So does this, in each such gap.
Points3 with_gaps_bridged(const SurfaceMesh& surface, const std::vector<BareFace>& faces,
                          const std::vector<Index>& line, const std::vector<bool>& sharp,
                          const std::vector<bool>& filled) {
    const double small = small_gap * scale_of(faces);
    const std::size_t n = sharp.size();
    std::size_t begin = 0;
    while (begin < n && !(sharp[(begin + n - 1) % n] && sharp[begin])) ++begin;
    const auto vertex = [&](std::size_t k) { return line[(begin + k) % n]; };
    std::vector<Index> run{vertex(0)};  // since the last gap
    Points3 result;
    const auto close_run = [&] {
        for (const Index v : run) result.push_back(surface.position(v));
    };
    for (std::size_t k = 0; k < n;) {
        std::size_t end = k;
        double length = 0.0;
        bool is_filled = false;
        for (; end < n && !sharp[(begin + end) % n]; ++end) {
            length += (surface.position(vertex(end + 1)) - surface.position(vertex(end))).norm();
            is_filled = is_filled || filled[(begin + end) % n];
        }
        if (length < small && !is_filled) {
            run.push_back(vertex(++k));
            continue;
        }
        // The other way round, what comes after the gap is a line that ends at it.
        std::vector<Index> back;
        for (std::size_t i = std::min(end + 40, end + n / 4); i > end; --i)
            back.push_back(vertex(i));
        back.push_back(vertex(end));
        const std::size_t before = back.size();
        const Vec3 way = surface.position(back.back()) - surface.position(run.back());
        std::vector<Index> longer_run = run, longer_back = back;
        if (!is_filled) {
            go_on(surface, faces, 0.45 * length, longer_run);
            go_on(surface, faces, 0.45 * length, longer_back);
        }
        // Only if the two come nearer to each other, and not past.
        const Vec3 left =
            surface.position(longer_back.back()) - surface.position(longer_run.back());
        if (left.dot(way) > 0.0 && left.norm() < way.norm()) {
            run = std::move(longer_run);
            back = std::move(longer_back);
        }
        close_run();
        bridge(positions_of(surface, run), positions_of(surface, back), scale_of(faces), result);
        run.assign(back.rbegin(),
                   back.rbegin() + static_cast<std::ptrdiff_t>(back.size() - before + 1));
        k = end;
    }
    close_run();
    result.back() = result.front();
    return result;
}

}  // namespace

EdgeLine edge_line(const SurfaceMesh& surface, const std::vector<BareFace>& faces,
                   const std::string& name, const std::vector<Index>& line, bool noisy) {
    constexpr double over_noise = 3.0, over_steps = 6.0;  // mm on a last
    const Points3 points = positions_of(surface, line);
    auto sharp = sharp_edges(surface, faces, line, least_run(points, scale_of(faces)));
    const auto filled = filled_edges(surface, line);
    for (std::size_t i = 0; i < sharp.size(); ++i) sharp[i] = sharp[i] && !filled[i];
    double all = 0.0, good = 0.0;
    for (std::size_t i = 0; i < sharp.size(); ++i) {
        const double length = (points[i + 1] - points[i]).norm();
        all += length;
        good += sharp[i] ? length : 0.0;
    }
    const double confidence = good / all;
    const bool is_edge = confidence >= mostly_sharp;
    Points3 even = !is_edge || confidence == 1.0
                       ? points
                       : with_gaps_bridged(surface, faces, line, sharp, filled);
    const bool uneven = noisy || is_jagged(even, over_noise * scale_of(faces));
    if (uneven || !is_edge) even_out(even, (is_edge ? over_noise : over_steps) * scale_of(faces));
    const bool leaves = uneven || !is_edge;
    return {{name, Polyline{std::move(even)}}, confidence, leaves};
}

}  // namespace lastflat
