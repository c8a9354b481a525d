#include "core/defeature/hollow_walls.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

#include "core/numerics/disjoint_sets.h"
#include "core/numerics/geometry.h"

namespace lastflat {
namespace {

/// A last's own hollows, at the waist and where the cone rises, are wider.
constexpr double widest_hollow_mm = 8.0;
/// Radians: a hollow edge that bends by more is sharp; by less it may be the rounding of the file.
constexpr double creased = 0.5, least_bend = 0.02;
/// Walls with corners nearer than this belong together: the two sides of a saw cut.
constexpr double together_mm = 4.0;
/// A wall is told from the surface that lies so near around it.
constexpr double around_mm = 15.0;
/// Radians, and the share of all area that is left of normals that look every way.
constexpr double stands_across = 0.5, every_way = 0.4;

std::vector<bool> hollow_faces(const SurfaceMesh& surface, const std::vector<BareFace>& faces) {
    std::vector<bool> hollow(faces.size(), false);
    for (const auto edge : surface.mesh.edges()) {
        const auto h = surface.mesh.halfedge_handle(edge, 0);
        const std::size_t left = at(surface.mesh.face_handle(h).idx());
        const std::size_t right = at(surface.mesh.opposite_face_handle(h).idx());
        const BareFace &a = faces[left], &b = faces[right];
        const Vec3 way = b.centre - a.centre;
        if (a.normal.dot(way) <= 0.0) continue;
        const Vec3 along = (surface.position(surface.mesh.to_vertex_handle(h).idx()) -
                            surface.position(surface.mesh.from_vertex_handle(h).idx()))
                               .normalized();
        const double across = (way - way.dot(along) * along).norm();  // a wall's faces may be long
        const double bend = angle_between(a.normal, b.normal);
        if (bend < creased && (bend < least_bend || bend * widest_hollow_mm < across)) continue;
        hollow[left] = hollow[right] = true;
    }
    return hollow;
}

using Cell = std::array<std::int64_t, 3>;

Cell cell_of(const Vec3& p, double size) {
    Cell cell{};
    for (std::size_t i = 0; i < 3; ++i)
        cell[i] = std::llround(p[static_cast<Eigen::Index>(i)] / size);
    return cell;
}

/// Whether a face is a wall among those that hang together with it nearby; the surface is looked at
/// in lumps, so that its fineness does not matter.
class Walls {
public:
    Walls(const SurfaceMesh& surface, const std::vector<BareFace>& faces) : faces_(faces) {
        std::map<Cell, Index> numbers;
        for (const BareFace& face : faces) {
            const auto [found, is_new] =
                numbers.emplace(cell_of(face.centre, lump_mm), static_cast<Index>(lumps_.size()));
            if (is_new) lumps_.emplace_back();
            Lump& lump = lumps_[at(found->second)];
            lump.sum += face.area * face.normal;
            lump.area += face.area;
            for (const Index v : corners_of(surface, static_cast<Index>(lump_of_.size())))
                lump.box.extend(surface.position(v));
            lump_of_.push_back(found->second);
        }
        for (const auto edge : surface.mesh.edges()) {
            const auto h = surface.mesh.halfedge_handle(edge, 0);
            const Index a = lump_of_[at(surface.mesh.face_handle(h).idx())];
            const Index b = lump_of_[at(surface.mesh.opposite_face_handle(h).idx())];
            if (a == b || contains(lumps_[at(a)].beside, b)) continue;
            lumps_[at(a)].beside.push_back(b);
            lumps_[at(b)].beside.push_back(a);
        }
    }

    bool is_wall(Index face) {
        const BareFace& own = faces_[at(face)];
        Vec3 sum = Vec3::Zero();
        double area = 0.0;
        stack_.assign(1, lump_of_[at(face)]);
        lumps_[at(stack_.front())].seen_by = face;
        while (!stack_.empty()) {
            const Lump& lump = lumps_[at(stack_.back())];
            stack_.pop_back();
            sum += lump.sum;
            area += lump.area;
            for (const Index next : lump.beside) {
                if (lumps_[at(next)].seen_by == face) continue;
                lumps_[at(next)].seen_by = face;
                // By its extent: the walls of a hole may be as long as it is deep.
                if (lumps_[at(next)].box.exteriorDistance(own.centre) < around_mm)
                    stack_.push_back(next);
            }
        }
        return sum.norm() < every_way * area || angle_between(own.normal, sum) > stands_across;
    }

private:
    static constexpr double lump_mm = 2.0;
    struct Lump {
        Vec3 sum = Vec3::Zero();    ///< of the normals, by area
        Eigen::AlignedBox3d box{};  ///< of the faces
        double area = 0.0;
        std::vector<Index> beside{};
        Index seen_by = -1;  ///< a face
    };
    const std::vector<BareFace>& faces_;
    std::vector<Lump> lumps_;
    std::vector<Index> lump_of_, stack_;
};

/// Each hollow face that is a wall.
std::vector<Index> walls_of(const SurfaceMesh& surface, const std::vector<BareFace>& faces) {
    const auto hollow = hollow_faces(surface, faces);
    Walls walls(surface, faces);
    std::vector<Index> found;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        if (hollow[f] && walls.is_wall(static_cast<Index>(f)))
            found.push_back(static_cast<Index>(f));
    }
    return found;
}

}  // namespace

std::vector<std::vector<Index>> hollow_walls(const SurfaceMesh& surface,
                                             const std::vector<BareFace>& faces) {
    struct Corner {
        Index wall;
        Vec3 position;
    };
    const auto walls = walls_of(surface, faces);
    std::map<Cell, std::vector<Corner>> corners;
    DisjointSets sets(walls.size());
    std::map<Index, Index> wall_at;  // per vertex, the first
    for (std::size_t w = 0; w < walls.size(); ++w) {
        for (const Index v : corners_of(surface, walls[w])) {
            const auto [first, is_new] = wall_at.try_emplace(v, static_cast<Index>(w));
            if (!is_new) {
                sets.join(static_cast<Index>(w), first->second);
                continue;
            }
            const Vec3 p = surface.position(v);
            const Cell cell = cell_of(p, together_mm);
            for (int k = 0; k < 27; ++k) {
                const Cell beside{cell[0] + k % 3 - 1, cell[1] + k / 3 % 3 - 1,
                                  cell[2] + k / 9 - 1};
                const auto found = corners.find(beside);
                if (found == corners.end()) continue;
                for (const Corner& other : found->second) {
                    if ((other.position - p).norm() < together_mm)
                        sets.join(static_cast<Index>(w), other.wall);
                }
            }
            corners[cell].push_back({static_cast<Index>(w), p});
        }
    }
    std::map<Index, std::vector<Index>> by_set;
    for (std::size_t w = 0; w < walls.size(); ++w)
        by_set[sets.find(static_cast<Index>(w))].push_back(walls[w]);
    std::vector<std::vector<Index>> patches;
    patches.reserve(by_set.size());
    for (auto& [set, patch] : by_set) patches.push_back(std::move(patch));
    return patches;
}

}  // namespace lastflat
