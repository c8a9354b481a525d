#include "core/cut/insert_curves.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/cut/cut.h"
#include "core/load/load_model.h"
#include "core/locate/curves.h"
#include "core/weld/weld.h"
#include "tests/helpers/errors.h"

namespace lastflat {
namespace {

using test::has;

/// A bumpy square of n x n cells over 0..100 mm; vertex j (n + 1) + i.
RawMesh bumpy(int n) {
    RawMesh raw;
    raw.label_sets = {{"left"}, {"right"}};
    const auto id = [n](int i, int j) { return static_cast<Index>(j * (n + 1) + i); };
    for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) {
            const double x = 100.0 * i / n, y = 100.0 * j / n;
            raw.positions.emplace_back(x, y, 2 * std::sin(x / 17) * std::cos(y / 23));
        }
    }
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            raw.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
            raw.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
            for (int k = 0; k < 2; ++k) raw.triangle_labels.push_back(2 * i < n ? 0 : 1);
        }
    }
    return raw;
}

SurfaceMesh surface_of(const RawMesh& raw) {
    WeldOptions options;
    options.unit_mm = 1.0;
    return weld(raw, options);
}

double area(const SurfaceMesh& surface) {
    double sum = 0.0;
    for (const auto face : surface.mesh.faces()) sum += surface.mesh.calc_face_area(face);
    return sum;
}

double length(const SurfaceMesh& surface, const Curve& curve) {
    double sum = 0.0;
    for (std::size_t i = 1; i < curve.vertices.size(); ++i)
        sum +=
            (surface.position(curve.vertices[i]) - surface.position(curve.vertices[i - 1])).norm();
    return sum;
}

bool runs_along_edges(const SurfaceMesh& surface, const Curve& curve) {
    for (std::size_t i = 1; i < curve.vertices.size(); ++i) {
        if (!surface.mesh
                 .find_halfedge(OpenMesh::VertexHandle(curve.vertices[i - 1]),
                                OpenMesh::VertexHandle(curve.vertices[i]))
                 .is_valid())
            return false;
    }
    return true;
}

CurveSource drawn(const std::string& name, const Points3& points) {
    return {name, Polyline{points}};
}

CurveSource geodesic(const std::string& name, const std::vector<std::string>& through) {
    return {name, ShortestPath{through}};
}

std::string insert_error(SurfaceMesh surface, const std::vector<CurveSource>& sources,
                         const std::vector<PointSource>& points = {}) {
    return test::error_of(
        [&] { (void)insert_curves(surface, locate_curves(surface, sources, points)); });
}

}  // namespace

TEST_SUITE("core/cut/insert_curves") {
    TEST_CASE("a drawn line whose points are one has no length") {
        SurfaceMesh surface = surface_of(bumpy(4));
        const CurveSource drawn{"drawn", Polyline{{{40.0, 50.0, 0.0}, {40.0, 50.0, 0.0}}}};
        CHECK(has(test::error_of(
                      [&] { (void)insert_curves(surface, locate_curves(surface, {drawn}, {})); }),
                  "has no length"));
    }

    TEST_CASE("an exact line that ends on a drawn one ends where that was put") {
        RawMesh raw = bumpy(20);
        for (Vec3& p : raw.positions) p.z() = 0.0;
        SurfaceMesh surface = surface_of(raw);
        // Drawn so near to a row of vertices that it is put on them.
        const CurveSource drawn{"drawn", Polyline{{{0.0, 50.1, 0.0}, {100.0, 50.15, 0.0}}}};
        CurveSource exact{"exact", Polyline{}};
        auto& points = std::get<Polyline>(exact.form).points;
        for (int row = 20; row > 10; --row) {
            points.emplace_back(52.0, 5.0 * row, 0.0);
            points.emplace_back(52.0, 5.0 * row - 3.0, 0.0);  // on the diagonal
        }
        points.emplace_back(52.0, 50.4, 0.0);
        const auto lines = locate_curves(surface, {drawn, exact}, {});
        CHECK(lines.at(0).starts_on_line);
        CHECK(lines.at(1).ends_on_line);
        CHECK(lines.at(1).snap < lines.at(0).snap);
        const InsertedCurves inserted = insert_curves(surface, lines);
        CutOptions cut;
        cut.cuts = {"drawn", "exact"};
        CHECK(cut_into_regions(surface, inserted.curves, cut).size() == 3);
    }

    TEST_CASE("curves become edges, and the surface stays the same set of points") {
        SurfaceMesh surface = surface_of(bumpy(20));
        const SurfaceMesh before = surface;
        const std::vector<PointSource> points{
            {"a", Vec3(3.3, 4.4, 0)}, {"b", Vec3(91.7, 77.7, 0)}, {"c", 25}};
        Points3 ring;
        for (int i = 0; i <= 24; ++i)
            ring.emplace_back(50 + 20 * std::cos(i % 24 * M_PI / 12),
                              50 + 20 * std::sin(i % 24 * M_PI / 12), 0);
        const auto lines =
            locate_curves(surface,
                          {{"row", VertexPath{{42, 43, 44}}},
                           geodesic("ab", {"a", "b"}),
                           geodesic("cb", {"c", "b"}),
                           drawn("ring", ring),
                           drawn("across", {{0.2, 40, 0}, {50, 44, 0}, {99.9, 61, 0}})},
                          points);
        const InsertedCurves inserted = insert_curves(surface, lines);
        REQUIRE(inserted.curves.size() == 5);
        for (const Curve& curve : inserted.curves) CHECK(runs_along_edges(surface, curve));
        CHECK(inserted.curves[3].closed());
        CHECK(area(surface) == doctest::Approx(area(before)).epsilon(1e-12));
        CHECK(inserted.added.size() + before.mesh.n_vertices() == surface.mesh.n_vertices());
        CHECK(inserted.smallest_angle > 0.0);
        // Along every old edge, the pieces add up to its length.
        std::map<std::pair<Index, Index>, std::vector<double>> on_edge;
        for (std::size_t k = 0; k < inserted.added.size(); ++k) {
            const SurfacePoint& point = inserted.added[k];
            const auto vertex = static_cast<Index>(before.mesh.n_vertices() + k);
            CHECK((position_of(before, point) - surface.position(vertex)).norm() < 1e-12);
            const auto support = point.support();
            if (support.size() == 2)
                on_edge[std::minmax(support[0], support[1])].push_back(
                    point.weight_of(std::max(support[0], support[1])));
        }
        for (const auto edge : before.mesh.edges()) {
            const auto h = before.mesh.halfedge_handle(edge, 0);
            const std::pair<Index, Index> ends = std::minmax(
                before.mesh.from_vertex_handle(h).idx(), before.mesh.to_vertex_handle(h).idx());
            std::vector<double> shares = on_edge[ends];
            std::sort(shares.begin(), shares.end());
            CHECK(std::adjacent_find(shares.begin(), shares.end()) == shares.end());
        }
    }

    TEST_CASE("a shortest path is as long as it says, and drawn ends reach the border") {
        SurfaceMesh surface = surface_of(bumpy(20));
        const std::vector<PointSource> points{{"a", Vec3(0.4, 33, 0)}, {"b", 20 * 21 + 7}};
        const auto lines = locate_curves(surface, {geodesic("ab", {"a", "b"})}, points);
        double along = 0.0;
        for (std::size_t i = 1; i < lines[0].points.size(); ++i)
            along += (position_of(surface, lines[0].points[i]) -
                      position_of(surface, lines[0].points[i - 1]))
                         .norm();
        const InsertedCurves inserted = insert_curves(surface, lines);
        CHECK(length(surface, inserted.curves[0]) == doctest::Approx(along).epsilon(1e-9));
        CHECK(
            surface.mesh.is_boundary(OpenMesh::VertexHandle(inserted.curves[0].vertices.front())));
    }

    TEST_CASE("curves that cross have a common vertex, and one may end on another") {
        SurfaceMesh surface = surface_of(bumpy(20));
        const auto curves =
            insert_curves(
                surface,
                locate_curves(surface, {drawn("up", {{33, 0, 0}, {35, 50, 0}, {33, 100, 0}}),
                                        drawn("over", {{0, 21, 0}, {50, 23, 0}, {100, 21, 0}}),
                                        drawn("stem", {{34.9, 63, 0}, {70, 66, 0}})}))
                .curves;
        const auto common = [](const Curve& a, const Curve& b) {
            return std::count_if(a.vertices.begin(), a.vertices.end(), [&](Index v) {
                return std::find(b.vertices.begin(), b.vertices.end(), v) != b.vertices.end();
            });
        };
        CHECK(common(curves[0], curves[1]) == 1);
        CHECK(common(curves[0], curves[2]) == 1);
        const CutOptions cuts{{"up", "over"}, {}};
        CHECK(cut_into_regions(surface, curves, cuts).size() == 4);
    }

    TEST_CASE("the same curve drawn twice is the same edges") {
        SurfaceMesh surface = surface_of(bumpy(16));
        const Points3 line{{0, 41, 0}, {50, 47, 0}, {100, 39, 0}};
        const auto curves =
            insert_curves(surface, locate_curves(surface, {drawn("a", line), drawn("b", line)}))
                .curves;
        CHECK(curves[0].vertices == curves[1].vertices);
    }

    TEST_CASE("groups meet along a line, also where one of them takes no part") {
        const CurveSource seam{"seam", GroupBorder{{"left", "right"}}};
        for (const std::vector<std::string>& groups :
             {std::vector<std::string>{}, std::vector<std::string>{"left"}}) {
            WeldOptions options;
            options.groups = groups;
            options.unit_mm = 1.0;
            SurfaceMesh surface = weld(bumpy(10), options);
            const auto curves = insert_curves(surface, locate_curves(surface, {seam})).curves;
            REQUIRE(curves[0].vertices.size() == 11);
            for (const Index v : curves[0].vertices) CHECK(surface.position(v).x() == 50.0);
        }
        const CurveSource other{"seam", GroupBorder{{"left", "middle"}}};
        CHECK(has(insert_error(surface_of(bumpy(4)), {other}),
                  "group_not_found /curves/seam/border_of/groups/1"));
    }

    TEST_CASE("a line of the model is a curve by its name") {
        RawMesh raw = bumpy(10);
        raw.lines.push_back({{"drawn by hand"}, {5, 38, 60, 115}});
        SurfaceMesh surface = surface_of(raw);
        const CurveSource source{"heel", NamedLine{"drawn by hand"}};
        const auto curves = insert_curves(surface, locate_curves(surface, {source})).curves;
        CHECK(runs_along_edges(surface, curves[0]));
        CHECK(curves[0].vertices.front() == 5);
        CHECK(curves[0].vertices.back() == 115);
        const CurveSource other{"heel", NamedLine{"another"}};
        CHECK(has(insert_error(surface, {other}), "curve_invalid /curves/heel/line"));
    }

    TEST_CASE("what cannot be found is refused with the curve, the item and the place") {
        const SurfaceMesh surface = surface_of(bumpy(10));
        CHECK(has(insert_error(surface, {drawn("far", {{1, 1, 0}, {50, 50, 40}})}),
                  "curve_invalid /curves/far/polyline/1: curve 'far', item 1: the point is"));
        const std::string above = insert_error(
            surface, {drawn("arch", {{10, 10, 0}, {20, 20, 40}, {30, 30, 70}, {40, 40, 0}})});
        CHECK(has(above,
                  "curve_invalid /curves/arch/polyline/1: curve 'arch', item 1: from 20.0 "
                  "20.0 40.0 to 30.0 30.0 70.0 it is up to "));
        CHECK(has(above, ", furthest at 30.0 30.0 70.0"));
        CHECK(has(insert_error(surface, {geodesic("g", {"a", "b"})}, {{"a", 3}}),
                  "curve_invalid /curves/g/to: curve 'g': there is no point 'b'"));
        CHECK(has(
            insert_error(surface,
                         {drawn("eight", {{20, 20, 0}, {60, 60, 0}, {60, 20, 0}, {20, 60, 0}})}),
            "curve_invalid /curves/eight: curve 'eight' meets itself"));
    }
}

}  // namespace lastflat
