#include "core/landmarks/centre_line.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "core/landmarks/bare_last.h"
#include "core/landmarks/furthest_pair.h"
#include "core/numerics/geometry.h"

namespace lastflat {
namespace {

/// The longest closed section of the surface with a plane: the faces in their order, and where the
/// section enters each.
struct PlaneSection {
    std::vector<Index> faces;
    Points3 entries;
};

PlaneSection section_of(const SurfaceMesh& surface, const Vec3& origin, const Vec3& normal) {
    const auto side = [&](Index v) { return normal.dot(surface.position(v) - origin) > 0.0; };
    const auto crosses = [&](OpenMesh::HalfedgeHandle h) {
        return !side(surface.mesh.from_vertex_handle(h).idx()) &&
               side(surface.mesh.to_vertex_handle(h).idx());
    };
    std::vector<bool> seen(surface.mesh.n_faces(), false);
    PlaneSection best;
    double longest = 0.0;
    for (const auto start : surface.mesh.halfedges()) {
        if (!crosses(start) ||
            seen[static_cast<std::size_t>(surface.mesh.face_handle(start).idx())])
            continue;
        PlaneSection section;
        double length = 0.0;
        OpenMesh::HalfedgeHandle h = start;
        do {  // into the face over a side that rises, out of it over the one that falls
            const Index face = surface.mesh.face_handle(h).idx();
            seen[static_cast<std::size_t>(face)] = true;
            const Vec3 a = surface.position(surface.mesh.from_vertex_handle(h).idx());
            const Vec3 b = surface.position(surface.mesh.to_vertex_handle(h).idx());
            const double below = normal.dot(a - origin), above = normal.dot(b - origin);
            const Vec3 at = a + below / (below - above) * (b - a);
            if (!section.entries.empty()) length += (at - section.entries.back()).norm();
            section.faces.push_back(face);
            section.entries.push_back(at);
            do h = surface.mesh.next_halfedge_handle(h);
            while (!crosses(surface.mesh.opposite_halfedge_handle(h)));
            h = surface.mesh.opposite_halfedge_handle(h);
        } while (h != start && section.faces.size() <= surface.mesh.n_faces());
        if (length <= longest) continue;
        longest = length;
        best = std::move(section);
    }
    return best;
}

/// The stretches of a section that lie on marked faces, each as the points from end to end and, at
/// both ends, `further` mm beyond.
std::vector<Points3> stretches(const PlaneSection& section, const std::vector<bool>& marked,
                               double further) {
    const std::size_t n = section.faces.size();
    const auto is_marked = [&](std::size_t i) {
        return marked[static_cast<std::size_t>(section.faces[i % n])];
    };
    const auto entry = [&](std::size_t i) { return section.entries[i % n]; };
    std::vector<Points3> found;
    for (std::size_t begin = 0; begin < n; ++begin) {
        if (!is_marked(begin) || is_marked(begin + n - 1)) continue;
        std::size_t end = begin;
        while (end < begin + n && is_marked(end)) ++end;
        std::size_t first = begin + n, last = end + n;
        while (first > end + 1 && (entry(first) - entry(begin)).norm() < further) --first;
        while (last < first + n - 1 && (entry(last) - entry(end)).norm() < further) ++last;
        found.emplace_back();
        for (std::size_t k = first; k <= last; ++k) found.back().push_back(entry(k));
    }
    return found;
}

/// The stretch of the upper in the plane through the heel, the toe and a third point that begins
/// nearest to `from`.
Points3 upper_section(const SurfaceMesh& surface, const std::vector<bool>& upper,
                      const Landmarks& found, const Vec3& third, const Vec3& from, bool exact) {
    const Vec3 normal =
        (found.toe_point - found.heel_point).cross(third - found.heel_point).normalized();
    // What was evened out has moved away from the faces' borders: the line goes beyond it.
    const double further = 0.03 * (found.toe_point - found.heel_point).norm();
    auto lines =
        stretches(section_of(surface, found.heel_point, normal), upper, exact ? 0.0 : further);
    const auto off = [&](const Points3& line) {
        return std::min((line.front() - from).norm(), (line.back() - from).norm());
    };
    const auto best =
        std::min_element(lines.begin(), lines.end(),
                         [&](const Points3& a, const Points3& b) { return off(a) < off(b); });
    if (best == lines.end()) fail_search("the middle plane does not meet the upper");
    if ((best->back() - from).norm() < (best->front() - from).norm())
        std::reverse(best->begin(), best->end());
    return *best;
}

/// Of the last `within` mm of a line, the point that is nearest to another.
std::size_t nearest_to(const Points3& other, double within, const Points3& line) {
    double beyond = 0.0, least = distance_to_line(other, line.back());
    std::size_t nearest = line.size() - 1;
    for (std::size_t i = line.size() - 1; i-- > 0 && beyond < within;) {
        const double distance = distance_to_line(other, line[i]);
        if (distance < least) {
            least = distance;
            nearest = i;
        }
        beyond += (line[i + 1] - line[i]).norm();
    }
    return nearest;
}

/// Ends a line, which goes too far, just beyond where it comes nearest to another.
void end_beyond(const Points3& other, double within, Points3& line) {
    constexpr double crossing = 1.0;  // mm on a last: so far it goes beyond
    const std::size_t nearest = nearest_to(other, within, line);
    const double least = distance_to_line(other, line[nearest]);
    std::size_t kept = nearest + 1;
    double further = 0.0;
    for (; kept < line.size() && further < crossing + least; ++kept)
        further += (line[kept] - line[kept - 1]).norm();
    line.resize(kept);
}

/// Ends a line, which goes too far, where it meets another.
void end_on(const Points3& other, double within, Points3& line) {
    const std::size_t nearest = nearest_to(other, within, line);
    Vec3 end = line[nearest];
    std::size_t kept = nearest;
    for (const std::size_t next : {nearest, nearest + 1}) {
        if (next == 0 || next == line.size()) continue;
        Vec3 low = line[next - 1], high = line[next];
        for (int halving = 0; halving < 50; ++halving) {
            const Vec3 a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
            if (distance_to_line(other, a) < distance_to_line(other, b))
                high = b;
            else
                low = a;
        }
        if (distance_to_line(other, low) >= distance_to_line(other, end)) continue;
        end = low;
        kept = next;
    }
    line.resize(kept);
    line.push_back(end);
}

}  // namespace

void find_centre_line(const SurfaceMesh& surface, const std::vector<bool>& upper,
                      const Points3& topline, bool is_exact, Landmarks& found) {
    const auto [back, front] = furthest_pair(topline, found.forward);
    const double length = (found.toe_point - found.heel_point).norm();
    const double within = 0.1 * length, touching = 1e-5 * length;
    const Points3 below = points_of(found.curves[0]), above = points_of(found.curves[1]);
    const auto is_on_either = [&](const Vec3& end) {
        return std::min(distance_to_line(below, end), distance_to_line(above, end)) < touching;
    };
    const auto section = [&](const char* name, const Vec3& third, const Vec3& from) {
        Points3 line = upper_section(surface, upper, found, third, from, is_exact);
        const bool is_bridged =
            is_exact && !(is_on_either(line.front()) && is_on_either(line.back()));
        if (is_bridged) line = upper_section(surface, upper, found, third, from, false);
        if (is_bridged || !is_exact) {
            const auto end = is_bridged ? end_on : end_beyond;
            end(above, within, line);
            std::reverse(line.begin(), line.end());
            end(below, within, line);
            std::reverse(line.begin(), line.end());
        }
        found.curves.push_back({name, Polyline{std::move(line)}});
    };
    section(curve_name::centre_front, front, found.toe_point);
    section(curve_name::heel, back, found.heel_point);
}

}  // namespace lastflat
