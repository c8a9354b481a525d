#include "core/landmarks/smooth_normals.h"

#include <algorithm>
#include <cmath>

#include "core/numerics/geometry.h"

namespace lastflat {
namespace {

/// The faces that share a vertex with each.
std::vector<std::vector<Index>> neighbourhoods(const SurfaceMesh& surface) {
    std::vector<std::vector<Index>> around(surface.mesh.n_faces());
    for (const auto face : surface.mesh.faces()) {
        auto& list = around[at(face.idx())];
        for (const auto v : surface.mesh.fv_range(face)) {
            for (const auto other : surface.mesh.vf_range(v)) {
                if (other != face && !contains(list, other.idx())) list.push_back(other.idx());
            }
        }
    }
    return around;
}

/// The value that half of the weight is below.
double weighted_median(std::vector<std::pair<double, double>> values) {
    double wanted = 0.0;
    for (const auto& [value, weight] : values) wanted += 0.5 * weight;
    auto begin = values.begin(), end = values.end();
    while (end - begin > 1) {
        const auto middle = begin + (end - begin) / 2;
        std::nth_element(begin, middle, end);
        double below = 0.0;
        for (auto i = begin; i != middle; ++i) below += i->second;
        if (below >= wanted) {
            end = middle;
        } else {
            wanted -= below;
            begin = middle;
        }
    }
    return values.empty() ? 0.0 : begin->first;
}

/// Per face, how far it is turned out of the mean of the three beside it.
double noise_of(const SurfaceMesh& surface, const std::vector<BareFace>& faces) {
    std::vector<std::pair<double, double>> turns;
    for (const auto face : surface.mesh.faces()) {
        Vec3 mean = Vec3::Zero();
        for (const auto other : surface.mesh.ff_range(face)) mean += faces[at(other.idx())].normal;
        const BareFace& own = faces[at(face.idx())];
        turns.emplace_back(angle_between(own.normal, mean), own.area);
    }
    return weighted_median(std::move(turns));
}

/// Calls visit(bend, length) for every edge; a bend is in radians, above 0 where it is convex.
template <class Visit>
void for_each_bend(const SurfaceMesh& surface, const std::vector<BareFace>& faces,
                   const Visit& visit) {
    for (const auto edge : surface.mesh.edges()) {
        const auto h = surface.mesh.halfedge_handle(edge, 0);
        const BareFace& a = faces[at(surface.mesh.face_handle(h).idx())];
        const BareFace& b =
            faces[at(surface.mesh.face_handle(surface.mesh.opposite_halfedge_handle(h)).idx())];
        const double bend = angle_between(a.normal, b.normal);
        visit(a.normal.dot(b.centre - a.centre) < 0.0 ? bend : -bend,
              surface.mesh.calc_edge_length(edge));
    }
}

/// A last bends outward, for the greater part, be its triangles as coarse as they may: about 0.6 of
/// all bending. Noise bends as much inward.
bool is_noisy(const SurfaceMesh& surface, const std::vector<BareFace>& faces) {
    constexpr double most_outward = 0.4, counted = 0.3, least_noise = 0.03;  // share; radians
    double outward = 0.0, all = 0.0;
    for_each_bend(surface, faces, [&](double bend, double length) {
        outward += length * std::clamp(bend, -counted, counted);
        all += length * std::min(std::abs(bend), counted);
    });
    return outward < most_outward * all && noise_of(surface, faces) > least_noise;
}

double mean_step(const SurfaceMesh& surface, const std::vector<BareFace>& faces) {
    double sum = 0.0;
    for (const auto edge : surface.mesh.edges()) {
        const auto h = surface.mesh.halfedge_handle(edge, 0);
        const auto a = surface.mesh.face_handle(h);
        const auto b = surface.mesh.face_handle(surface.mesh.opposite_halfedge_handle(h));
        sum += (faces[at(a.idx())].centre - faces[at(b.idx())].centre).norm();
    }
    return sum / static_cast<double>(surface.mesh.n_edges());
}

/// Per face, the mean normal of the evenest neighbourhood that it is in: on its own side of a sharp
/// edge, and whatever its own normal is.
std::vector<Vec3> guides_of(const std::vector<BareFace>& faces,
                            const std::vector<std::vector<Index>>& around) {
    std::vector<Vec3> means(faces.size());
    std::vector<double> uneven(faces.size());  // 0 where all normals are one
    for (std::size_t f = 0; f < faces.size(); ++f) {
        double area = faces[f].area;
        Vec3 sum = faces[f].area * faces[f].normal;
        for (const Index n : around[f]) {
            sum += faces[at(n)].area * faces[at(n)].normal;
            area += faces[at(n)].area;
        }
        means[f] = sum.normalized();
        uneven[f] = 1.0 - sum.norm() / area;
    }
    std::vector<Vec3> guides(faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f) {
        std::size_t best = f;
        for (const Index n : around[f]) {
            if (uneven[at(n)] < uneven[best]) best = at(n);
        }
        guides[f] = means[best];
    }
    return guides;
}

}  // namespace

double typical_bend(const SurfaceMesh& surface, const std::vector<BareFace>& faces) {
    std::vector<std::pair<double, double>> bends;
    for_each_bend(surface, faces,
                  [&](double bend, double length) { bends.emplace_back(std::abs(bend), length); });
    return weighted_median(std::move(bends));
}

double sharp_bend(const SurfaceMesh& surface, const std::vector<BareFace>& faces) {
    return std::max(0.18, 3.0 * typical_bend(surface, faces));
}

bool smooth_normals(const SurfaceMesh& surface, std::vector<BareFace>& faces) {
    constexpr double even = 0.006, alike = 0.35;  // radians
    constexpr int most_rounds = 40;
    if (!is_noisy(surface, faces)) return false;
    const auto around = neighbourhoods(surface);
    const double reach = 2.0 * mean_step(surface, faces);
    for (int round = 0; round < most_rounds && noise_of(surface, faces) > even; ++round) {
        const std::vector<Vec3> guides = guides_of(faces, around);
        const std::vector<BareFace> before = faces;
        for (std::size_t f = 0; f < faces.size(); ++f) {
            Vec3 sum = before[f].area * before[f].normal;
            for (const Index n : around[f]) {
                const BareFace& other = before[at(n)];
                const double apart = (other.centre - before[f].centre).norm() / reach;
                const double turned = (guides[at(n)] - guides[f]).norm() / alike;
                sum += other.area * std::exp(-apart * apart - turned * turned) * other.normal;
            }
            faces[f].normal = sum.normalized();
        }
    }
    return true;
}

}  // namespace lastflat
