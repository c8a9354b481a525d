#include "core/landmarks/sole_and_top.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "core/landmarks/min_cut.h"
#include "core/landmarks/smooth_normals.h"
#include "core/numerics/geometry.h"

namespace lastflat {
namespace {

std::vector<GraphEdge> graph_of(const SurfaceMesh& surface, const std::vector<BareFace>& faces) {
    const double sharp = sharp_bend(surface, faces);
    std::vector<GraphEdge> edges;
    for (const auto edge : surface.mesh.edges()) {
        const auto h = surface.mesh.halfedge_handle(edge, 0);
        const Index a = surface.mesh.face_handle(h).idx();
        const Index b = surface.mesh.face_handle(surface.mesh.opposite_halfedge_handle(h)).idx();
        const BareFace &left = faces[static_cast<std::size_t>(a)],
                       &right = faces[static_cast<std::size_t>(b)];
        const bool convex = left.normal.dot(right.centre - left.centre) < 0.0;
        const double bend = convex ? angle_between(left.normal, right.normal) : 0.0;
        edges.push_back({a, b, parting_cost(bend, sharp, surface.mesh.calc_edge_length(edge))});
    }
    return edges;
}

/// Pieces of a set that are not small.
std::vector<bool> large_pieces(const SurfaceMesh& surface, const std::vector<BareFace>& faces,
                               const std::vector<bool>& set) {
    constexpr double small = 0.05;  // of the set's area
    std::vector<Index> piece(set.size(), -1);
    std::vector<double> areas;
    double all = 0.0;
    for (std::size_t seed = 0; seed < set.size(); ++seed) {
        if (!set[seed] || piece[seed] >= 0) continue;
        const auto number = static_cast<Index>(areas.size());
        areas.push_back(0.0);
        std::vector<std::size_t> stack{seed};
        piece[seed] = number;
        while (!stack.empty()) {
            const std::size_t f = stack.back();
            stack.pop_back();
            areas.back() += faces[f].area;
            for (const auto n : surface.mesh.ff_range(OpenMesh::FaceHandle(static_cast<int>(f)))) {
                const auto next = static_cast<std::size_t>(n.idx());
                if (!set[next] || piece[next] >= 0) continue;
                piece[next] = number;
                stack.push_back(next);
            }
        }
        all += areas.back();
    }
    std::vector<bool> kept(set.size());
    for (std::size_t f = 0; f < set.size(); ++f)
        kept[f] = set[f] && areas[static_cast<std::size_t>(piece[f])] >= small * all;
    return kept;
}

/// The faces on the first side of the least cut, as one piece without holes that holds `seed`; the
/// rest holds `other`.
std::vector<bool> parted(const SurfaceMesh& surface, const std::vector<GraphEdge>& graph,
                         const std::vector<Side2>& nodes, std::size_t seed, std::size_t other) {
    auto inside = piece_of(surface, minimum_cut(graph, nodes), seed);
    inside.flip();
    auto outside = piece_of(surface, inside, other);
    outside.flip();
    return outside;
}

/// The faces that hang together with one and lie in about the same plane.
std::vector<bool> flat_around(const SurfaceMesh& surface, const std::vector<BareFace>& faces,
                              std::size_t seed) {
    constexpr double alike = 0.94;  // of the normals: 20 degrees
    Vec3 normal = faces[seed].normal;
    std::vector<bool> piece;
    for (int round = 0; round < 3; ++round) {
        std::vector<bool> set(faces.size());
        for (std::size_t f = 0; f < faces.size(); ++f)
            set[f] = f == seed || faces[f].normal.dot(normal) > alike;
        piece = piece_of(surface, set, seed);
        normal.setZero();
        for (std::size_t f = 0; f < faces.size(); ++f) {
            if (piece[f]) normal += faces[f].area * faces[f].normal;
        }
        normal.normalize();
    }
    return piece;
}

/// Per face, how far along a direction it is: 0 to 1 over the last.
std::vector<double> shares_along(const std::vector<BareFace>& faces, const Vec3& direction) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    std::vector<double> shares;
    for (const BareFace& face : faces) {
        shares.push_back(direction.dot(face.centre));
        least = std::min(least, shares.back());
        most = std::max(most, shares.back());
    }
    for (double& share : shares) share = (share - least) / (most - least);
    return shares;
}

/// The face of a set that best stands for it: large, and turned as the set is on the whole.
std::optional<std::size_t> middle_of(const std::vector<BareFace>& faces,
                                     const std::vector<bool>& set) {
    Vec3 normal = Vec3::Zero();
    for (std::size_t f = 0; f < faces.size(); ++f) {
        if (set[f]) normal += faces[f].area * faces[f].normal;
    }
    normal.normalize();
    std::optional<std::size_t> best;
    double most = 0.0;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const double worth =
            set[f] ? faces[f].area * std::pow(std::max(0.0, faces[f].normal.dot(normal)), 8) : 0.0;
        if (worth <= most) continue;
        most = worth;
        best = f;
    }
    return best;
}

/// Of a set the faces that are as high as its highest tenth, by area.
std::vector<bool> highest_of(const std::vector<BareFace>& faces, const std::vector<bool>& set,
                             const std::vector<double>& height) {
    std::vector<std::size_t> order;
    double all = 0.0;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        if (!set[f]) continue;
        order.push_back(f);
        all += faces[f].area;
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return height[a] > height[b]; });
    std::vector<bool> highest(faces.size(), false);
    double area = 0.0;
    for (std::size_t i = 0; i < order.size() && area < 0.1 * all; ++i) {
        highest[order[i]] = true;
        area += faces[order[i]].area;
    }
    return highest;
}

constexpr double flat = 0.75, upright = 0.25, slanted = 0.5;  // of the normal along the vertical
constexpr double forefoot = 0.6, cone = 0.6;  // of length and height: the top is behind and above

}  // namespace

SoleAndTop sole_and_top(const SurfaceMesh& surface, const std::vector<BareFace>& faces,
                        const LastFrame& frame, TopChoice choice) {
    const auto graph = graph_of(surface, faces);
    const auto along = shares_along(faces, frame.forward), height = shares_along(faces, frame.up);
    const std::size_t n = faces.size();
    std::vector<bool> down(n), up(n), sides(n);
    for (std::size_t f = 0; f < n; ++f) {
        const double rise = faces[f].normal.dot(frame.up);
        down[f] = rise < -flat;
        up[f] = rise > flat && along[f] < forefoot && height[f] > cone;
        sides[f] = rise > -upright;
    }
    down = large_pieces(surface, faces, down);
    sides = large_pieces(surface, faces, sides);
    const auto middle_of_sole = middle_of(faces, down);
    const auto middle_of_top =
        middle_of(faces, choice == TopChoice::flattest ? up : highest_of(faces, up, height));
    if (!middle_of_sole) fail_search("it has no flat sole");
    if (!middle_of_top) fail_search("it has no flat top over the heel");
    std::vector<Side2> nodes(n, Side2::free);
    for (std::size_t f = 0; f < n; ++f)
        nodes[f] = down[f] ? Side2::first : sides[f] ? Side2::second : Side2::free;
    nodes[*middle_of_top] = Side2::second;
    SoleAndTop parts{parted(surface, graph, nodes, *middle_of_sole, *middle_of_top), {}};
    const auto top = flat_around(surface, faces, *middle_of_top);
    for (std::size_t f = 0; f < n; ++f) {
        const bool is_side =
            std::abs(faces[f].normal.dot(frame.up)) < slanted || along[f] > forefoot;
        nodes[f] = parts.sole[f] ? Side2::second
                   : top[f]      ? Side2::first
                   : is_side     ? Side2::second
                                 : Side2::free;
    }
    parts.top = parted(surface, graph, nodes, *middle_of_top, *middle_of_sole);
    return parts;
}

/// The one line between the faces of a side and the others, as a closed path of vertices.
std::vector<Index> line_around(const SurfaceMesh& surface, const std::vector<bool>& inside,
                               const char* what) {
    std::map<Index, Index> next;
    for (const auto h : surface.mesh.halfedges()) {
        const auto twin = surface.mesh.opposite_halfedge_handle(h);
        if (!inside[static_cast<std::size_t>(surface.mesh.face_handle(h).idx())] ||
            inside[static_cast<std::size_t>(surface.mesh.face_handle(twin).idx())])
            continue;
        const Index from = surface.mesh.from_vertex_handle(h).idx();
        if (!next.emplace(from, surface.mesh.to_vertex_handle(h).idx()).second)
            fail_search(std::string("the ") + what + " touches itself at " +
                        position_text(surface.position(from)));
    }
    if (next.empty()) fail_search(std::string("there is no ") + what);
    std::vector<Index> line{next.begin()->first};
    do {
        line.push_back(next.at(line.back()));
    } while (line.back() != line.front() && line.size() <= next.size());
    if (line.size() != next.size() + 1)
        fail_search(std::string("the ") + what + " would be more than one line; another is at " +
                    position_text(surface.position(next.rbegin()->first)));
    return line;
}

}  // namespace lastflat
