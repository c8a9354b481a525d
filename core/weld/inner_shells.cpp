#include "core/weld/inner_shells.h"

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "core/numerics/disjoint_sets.h"
#include "core/weld/check_manifold.h"

namespace lastflat {
namespace {

/// The solid angle under which a triangle is seen, with a sign; [van-oosterom-1983].
double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    return 2.0 * std::atan2(a.dot(b.cross(c)),
                            la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

struct Piece {
    Eigen::AlignedBox3d box;
    std::vector<std::size_t> triangles;
};

bool is_inside(const Faces& faces, const Piece& outer, const Vec3& point) {
    double angle = 0.0;
    for (const std::size_t t : outer.triangles) {
        const Triangle& corners = faces.triangles[t];
        angle += solid_angle(faces.position(corners[0]) - point, faces.position(corners[1]) - point,
                             faces.position(corners[2]) - point);
    }
    return std::abs(angle) > 2.0 * std::numbers::pi;  // of a full 4 pi inside, 0 outside
}

std::map<Index, Piece> pieces_of(const Faces& faces) {
    DisjointSets sets(faces.positions.size());
    for (const Triangle& t : faces.triangles) {
        sets.join(t[0], t[1]);
        sets.join(t[0], t[2]);
    }
    std::map<Index, Piece> pieces;
    for (std::size_t t = 0; t < faces.triangles.size(); ++t) {
        Piece& piece = pieces[sets.find(faces.triangles[t][0])];
        piece.triangles.push_back(t);
        for (const Index v : faces.triangles[t]) piece.box.extend(faces.position(v));
    }
    return pieces;
}

}  // namespace

void drop_inner_shells(Faces& faces, std::vector<Repair>& repairs) {
    if (!is_closed(faces.sides())) return;
    const auto pieces = pieces_of(faces);
    if (pieces.size() < 2) return;
    const Piece* outer = nullptr;
    for (const auto& [id, piece] : pieces) {
        if (outer == nullptr || piece.box.diagonal().norm() > outer->box.diagonal().norm())
            outer = &piece;
    }
    std::set<std::size_t> dropped;
    RepairNote note;
    for (const auto& [id, piece] : pieces) {
        const Vec3& point = faces.position(id);
        if (&piece == outer || !outer->box.contains(piece.box) || !is_inside(faces, *outer, point))
            continue;
        note.at(point);
        dropped.insert(piece.triangles.begin(), piece.triangles.end());
    }
    if (dropped.empty()) return;
    std::size_t t = 0;
    faces.keep_if([&](const Triangle&) { return !dropped.contains(t++); });
    note.write(repairs, "inner_shells_dropped",
               "closed shells inside the largest one were left out");
}

}  // namespace lastflat
