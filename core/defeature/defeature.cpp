#include "core/defeature/defeature.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <numbers>
#include <optional>
#include <set>
#include <string>

#include "core/defeature/feature_search.h"
#include "core/locate/surface_point.h"
#include "core/numerics/geometry.h"
#include "core/numerics/least_area.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

/// A feature's size on the last: across a round one, and along one that is as narrow as its area.
constexpr double widest_mm = 15.0, longest_mm = 60.0;
constexpr double largest_mm2 = std::numbers::pi / 4.0 * widest_mm * widest_mm;
/// How far beyond its hollow walls a feature is looked for: where the whole of a deep one is not to
/// be had, its bottom is.
constexpr std::array beyond_mm{32.0, 16.0, 8.0};
/// Of the filling: what takes away less than this much more area hardly stands out.
constexpr double least_excess = 1.1;
/// A last carries a few; what has more is another thing, such as a lattice.
constexpr std::size_t most_features = 300;
/// The triangulation takes the cube of a rim's vertices.
constexpr std::size_t most_rim_vertices = 512;

double width_of(const Points3& points) {
    double widest = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j)
            widest = std::max(widest, (points[i] - points[j]).norm());
    }
    return widest;
}

/// What takes a feature's place.
struct Filling {
    std::vector<Triangle> triangles;
    std::vector<FilledFeature> places;  ///< per rim
    double area = 0.0;
};

using Edge = std::pair<Index, Index>;  ///< ascending

/// `new_edges` are those of fillings before.
std::optional<Filling> filling_of(const SurfaceMesh& surface, const Feature& feature,
                                  std::set<Edge>& new_edges) {
    Filling filling;
    for (const Rim& rim : feature.rims) {
        if (rim.size() > most_rim_vertices) return std::nullopt;
        Points3 corners;
        for (const Index v : rim) corners.push_back(surface.position(v));
        const double width = width_of(corners);
        if (width > longest_mm) return std::nullopt;
        // An edge of the last between two vertices of the rim would get a third face.
        const auto taken = [&](std::size_t i, std::size_t j) {
            if (new_edges.contains(std::minmax(rim[i], rim[j]))) return true;
            const auto h = surface.mesh.find_halfedge(OpenMesh::VertexHandle(rim[i]),
                                                      OpenMesh::VertexHandle(rim[j]));
            return h.is_valid() &&
                   !(contains(feature.faces, surface.mesh.face_handle(h).idx()) &&
                     contains(feature.faces, surface.mesh.opposite_face_handle(h).idx()));
        };
        const auto triangles = least_area_triangles(corners, taken);
        if (triangles.empty()) return std::nullopt;
        Vec3 middle = Vec3::Zero();
        for (const Vec3& p : corners) middle += p / static_cast<double>(corners.size());
        filling.places.push_back({middle, width, 0, static_cast<Index>(triangles.size())});
        double area = 0.0;
        for (const Triangle& t : triangles) {
            filling.triangles.push_back({rim[at(t[0])], rim[at(t[1])], rim[at(t[2])]});
            const Triangle& made = filling.triangles.back();
            if (!(height_share(surface, made) > tolerance::filling_height)) return std::nullopt;
            area += 0.5 * doubled_area_vector(surface, made).norm();
        }
        if (area > largest_mm2) return std::nullopt;
        filling.area += area;
    }
    double before = 0.0;
    for (const Index f : feature.faces)
        before += 0.5 * doubled_area_vector(surface, corners_of(surface, f)).norm();
    if (before < least_excess * filling.area) return std::nullopt;
    for (const Triangle& t : filling.triangles) {
        for (std::size_t i = 0; i < 3; ++i) new_edges.insert(std::minmax(t[i], t[(i + 1) % 3]));
    }
    return filling;
}

/// Features with what takes their places.
struct Found {
    std::vector<Feature> features;
    std::vector<Filling> fillings;
    std::set<Edge> new_edges;
    std::vector<bool> gone;  ///< per face

    /// Takes all of them, or none: whether they share no face with others, and can be filled.
    bool add(const SurfaceMesh& surface, std::vector<Feature> more) {
        std::vector<Filling> filled;
        std::set<Edge> edges = new_edges;
        for (const Feature& feature : more) {
            for (const Index f : feature.faces) {
                if (gone[at(f)]) return false;
            }
            auto filling = filling_of(surface, feature, edges);
            if (!filling) return false;
            filled.push_back(std::move(*filling));
        }
        for (const Feature& feature : more) {
            for (const Index f : feature.faces) gone[at(f)] = true;
        }
        new_edges = std::move(edges);
        std::move(more.begin(), more.end(), std::back_inserter(features));
        std::move(filled.begin(), filled.end(), std::back_inserter(fillings));
        return !more.empty();
    }
};

/// The surface with the features' faces replaced.
void replace_faces(SurfaceMesh& surface, const Found& found) {
    const auto& [features, fillings, new_edges, gone] = found;
    Points3 positions;
    for (const auto v : surface.mesh.vertices()) positions.push_back(surface.position(v.idx()));
    std::vector<Triangle> triangles;
    std::vector<FaceOrigin> origins;
    for (std::size_t f = 0; f < gone.size(); ++f) {
        if (gone[f]) continue;
        triangles.push_back(corners_of(surface, static_cast<Index>(f)));
        origins.push_back(surface.origins[f]);
    }
    for (std::size_t i = 0; i < features.size(); ++i) {
        for (const Triangle& t : fillings[i].triangles) {
            triangles.push_back(t);
            origins.push_back(surface.origins[at(features[i].faces.front())].filling_beside());
        }
    }
    surface.mesh = build_mesh(positions, triangles);
    surface.origins = std::move(origins);
}

void note(SurfaceMesh& surface, const Found& found) {
    const auto& [features, fillings, new_edges, gone] = found;
    Repair repair{"features_filled", "", features.size()};
    std::size_t through = 0;
    Index first_face = 0;
    for (const Filling& filling : fillings)
        first_face -= static_cast<Index>(filling.triangles.size());
    first_face += static_cast<Index>(surface.mesh.n_faces());
    for (std::size_t i = 0; i < features.size(); ++i) {
        through += features[i].rims.size() > 1 ? 1 : 0;
        for (FilledFeature place : fillings[i].places) {
            place.first_face = first_face;
            first_face += place.faces;
            surface.filled.push_back(place);
            if (repair.positions.size() == Repair::most_listed) continue;
            repair.positions.push_back(place.centre);
            repair.lengths_mm.push_back(place.across_mm);
        }
    }
    repair.detail =
        std::to_string(features.size()) +
        " small features (holes, cuts, nails, knobs) were taken off the last and the "
        "surface filled there" +
        (through > 0 ? "; " + std::to_string(through) + " of them ran through it" : "") +
        "; they stay with \"features\": \"keep\"";
    surface.repairs.push_back(std::move(repair));
}

bool wants(const Request& request) {
    if (request.cut.features != FeatureRule::automatic)
        return request.cut.features == FeatureRule::fill;
    return !says_how_to_cut(request) && request.curves.empty();
}

}  // namespace

void defeature(SurfaceMesh& surface, const Request& request) {
    if (!wants(request) || is_open(surface)) return;
    Found found{{}, {}, {}, std::vector<bool>(surface.mesh.n_faces(), false)};
    const FeatureSearch search(surface);
    std::size_t tried = 0;
    for (const auto& walls : search.walls()) {
        if (found.gone[at(walls.front())]) continue;
        if (++tried > most_features) break;
        for (const double beyond : beyond_mm) {
            if (found.add(surface, search.features_around(walls, beyond))) break;
        }
    }
    if (found.features.empty()) return;
    replace_faces(surface, found);
    note(surface, found);
}

}  // namespace lastflat
