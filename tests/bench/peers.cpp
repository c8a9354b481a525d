#include "tests/bench/peers.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_parameterization/ARAP_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Barycentric_mapping_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Discrete_conformal_map_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/LSCM_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Mean_value_coordinates_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/parameterize.h>
#include <CGAL/Surface_mesh_shortest_path.h>

namespace lastflat::peers {
namespace {

namespace smp = CGAL::Surface_mesh_parameterization;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using TriangleMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Vertex = TriangleMesh::Vertex_index;
using UvMap = TriangleMesh::Property_map<Vertex, Kernel::Point_2>;

/// CGAL's concept of a border parameterizer, with places that are given.
class GivenBorder {
public:
    GivenBorder() = default;
    explicit GivenBorder(const std::vector<Kernel::Point_2>& places) : places_(&places) {}

    template <class VertexUvMap, class VertexIndexMap, class VertexParameterizedMap>
    smp::Error_code parameterize(const TriangleMesh& mesh, TriangleMesh::Halfedge_index border,
                                 VertexUvMap uv, VertexIndexMap, VertexParameterizedMap done) {
        for (const Vertex v : CGAL::vertices_around_face(border, mesh)) {
            put(uv, v, (*places_)[v]);
            put(done, v, true);
        }
        return smp::OK;
    }
    bool is_border_convex() const { return true; }

private:
    const std::vector<Kernel::Point_2>* places_ = nullptr;  // by vertex
};

}  // namespace

struct CgalMesh::Mesh {
    TriangleMesh triangles;
    TriangleMesh::Halfedge_index border;
    std::vector<Index> border_vertices;
    UvMap uv;

    template <class Parameterizer>
    Points2 parameterize(Parameterizer parameterizer) {
        const smp::Error_code error = smp::parameterize(triangles, parameterizer, border, uv);
        if (error != smp::OK) throw std::runtime_error(smp::get_error_message(error));
        Points2 points;
        for (const Vertex v : triangles.vertices()) points.emplace_back(uv[v].x(), uv[v].y());
        return points;
    }

    template <template <class, class> class Parameterizer>
    Points2 with_border(const Points2& places) {
        std::vector<Kernel::Point_2> by_vertex(triangles.number_of_vertices());
        for (std::size_t i = 0; i < places.size(); ++i) {
            by_vertex[static_cast<std::size_t>(border_vertices[i])] = {places[i].x(),
                                                                       places[i].y()};
        }
        return parameterize(Parameterizer<TriangleMesh, GivenBorder>(GivenBorder(by_vertex)));
    }
};

namespace {

template <class M, class B>
using Tutte = smp::Barycentric_mapping_parameterizer_3<M, B>;
template <class M, class B>
using MeanValue = smp::Mean_value_coordinates_parameterizer_3<M, B>;
template <class M, class B>
using Harmonic = smp::Discrete_conformal_map_parameterizer_3<M, B>;

}  // namespace

CgalMesh::CgalMesh(const Region& region) : mesh_(std::make_unique<Mesh>()) {
    for (const Vec3& p : region.positions) mesh_->triangles.add_vertex({p.x(), p.y(), p.z()});
    const auto vertex = [](Index v) { return Vertex(static_cast<Vertex::size_type>(v)); };
    for (const Triangle& t : region.triangles) {
        mesh_->triangles.add_face(vertex(t[0]), vertex(t[1]), vertex(t[2]));
    }
    for (const auto h : mesh_->triangles.halfedges()) {
        if (mesh_->triangles.is_border(h)) mesh_->border = h;
    }
    mesh_->border_vertices = region.border;
    mesh_->uv = mesh_->triangles.add_property_map<Vertex, Kernel::Point_2>("v:uv").first;
}

CgalMesh::~CgalMesh() = default;

Points2 CgalMesh::tutte(const Points2& border) {
    return mesh_->with_border<Tutte>(border);
}
Points2 CgalMesh::mean_value(const Points2& border) {
    return mesh_->with_border<MeanValue>(border);
}
Points2 CgalMesh::harmonic(const Points2& border) {
    return mesh_->with_border<Harmonic>(border);
}
Points2 CgalMesh::lscm() {
    return mesh_->parameterize(smp::LSCM_parameterizer_3<TriangleMesh>());
}
Points2 CgalMesh::arap(double lambda) {
    return mesh_->parameterize(smp::ARAP_parameterizer_3<TriangleMesh>(
        smp::ARAP_parameterizer_3<TriangleMesh>::Border_parameterizer(),
        smp::ARAP_parameterizer_3<TriangleMesh>::Solver_traits(), lambda));
}

std::vector<double> CgalMesh::distances_from(Index vertex) {
    CGAL::Surface_mesh_shortest_path<CGAL::Surface_mesh_shortest_path_traits<Kernel, TriangleMesh>>
        paths(mesh_->triangles);
    paths.add_source_point(Vertex(static_cast<Vertex::size_type>(vertex)));
    std::vector<double> distances;
    for (const Vertex v : mesh_->triangles.vertices()) {
        distances.push_back(paths.shortest_distance_to_source_points(v).first);
    }
    return distances;
}

}  // namespace lastflat::peers
