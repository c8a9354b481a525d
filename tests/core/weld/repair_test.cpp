#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include "core/load/load_model.h"
#include "core/weld/weld.h"

namespace lastflat {
namespace {

std::size_t count_of(const SurfaceMesh& surface, const std::string& code) {
    for (const Repair& repair : surface.repairs) {
        if (repair.code == code) return repair.count;
    }
    return 0;
}

std::size_t border_edges(const SurfaceMesh& surface) {
    std::size_t count = 0;
    for (const auto edge : surface.mesh.edges()) count += surface.mesh.is_boundary(edge) ? 1U : 0U;
    return count;
}

void add(RawMesh& mesh, const Points3& positions, const std::vector<Triangle>& triangles) {
    const auto base = static_cast<Index>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), positions.begin(), positions.end());
    if (mesh.label_sets.empty()) mesh.label_sets.emplace_back();
    for (const Triangle& t : triangles) {
        mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
        mesh.triangle_labels.push_back(0);
    }
}

/// A cap over a circle of `n` vertices at height z: a cone towards the tip.
void add_cone(RawMesh& mesh, int n, double z, double tip, double turn) {
    Points3 positions{{0, 0, tip}};
    std::vector<Triangle> triangles;
    for (int i = 0; i < n; ++i) {
        const double angle = turn + 2 * 3.14159265358979 * i / n;
        positions.emplace_back(100 * std::cos(angle), 100 * std::sin(angle), z);
        const Index a = i + 1, b = (i + 1) % n + 1;
        triangles.push_back(tip > z ? Triangle{0, a, b} : Triangle{0, b, a});
    }
    add(mesh, positions, triangles);
}

SurfaceMesh welded(const std::string& obj) {
    return weld(load_model(obj));
}

}  // namespace

TEST_SUITE("core/weld/repair") {
    TEST_CASE("repeated and collapsed faces are left out and counted") {
        RawMesh raw = load_model("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\nf 3 1 2\n");
        raw.triangles.push_back({0, 0, 2});
        raw.triangle_labels.push_back(0);
        const SurfaceMesh surface = weld(raw);
        CHECK(surface.mesh.n_faces() == 2);
        CHECK(count_of(surface, "duplicate_faces_dropped") == 1);
        CHECK(count_of(surface, "faces_dropped") == 1);
    }

    TEST_CASE("a flat triangle goes without leaving a hole") {
        // Vertex 4 lies on the edge 1 2; the flat triangle 1 2 4 fills nothing between them.
        const SurfaceMesh cap = welded(
            "v 0 0 0\nv 2 0 0\nv 1 1 0\nv 1 0 0\nv 1 -1 0\nf 1 2 3\nf 2 1 4\nf 1 5 4\nf 5 2 4\n");
        CHECK(count_of(cap, "flat_faces_removed") == 1);
        CHECK(cap.mesh.n_faces() == 4);
        CHECK(border_edges(cap) == 4);
        // A needle: two of its corners are one place.
        const SurfaceMesh needle = welded(
            "v 0 0 0\nv 2 0 0\nv 1 1 0\nv 1.00000001 1 0\nv 3 1 0\nf 1 2 3\nf 2 4 3\nf 2 5 4\n");
        CHECK(needle.mesh.n_faces() == 2);
        CHECK(border_edges(needle) == 4);
    }

    TEST_CASE("faces that wind against the rest are turned") {
        const SurfaceMesh surface =
            welded("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 4 3\nf 2 5 3\n");
        CHECK(count_of(surface, "faces_turned") == 1);
    }

    TEST_CASE("a surface with one side only is refused") {
        CHECK_THROWS_AS(
            (void)welded("v 0 0 0\nv 1 0 0\nv 2 1 0\nv 1 2 1\nv 0 1 1\nf 1 2 3\nf 2 3 4\nf 3 4 "
                         "5\nf 4 5 1\nf 5 1 2\n"),
            Error);
    }

    TEST_CASE("a loose crumb is dropped, a second piece of some size is not") {
        const std::string square = "v 0 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\nf 1 2 3\nf 1 3 4\n";
        const SurfaceMesh crumb = welded(square + "v 20 0 0\nv 20.1 0 0\nv 20 0.1 0\nf 5 6 7\n");
        CHECK(count_of(crumb, "strays_dropped") == 1);
        CHECK(crumb.mesh.n_faces() == 2);
        const SurfaceMesh pair = welded(square + "v 20 0 0\nv 29 0 0\nv 20 9 0\nf 5 6 7\n");
        CHECK(count_of(pair, "strays_dropped") == 0);
        CHECK(pair.mesh.n_faces() == 3);
    }

    TEST_CASE("patches with gaps and T-junctions become one closed surface") {
        for (const double gap : {0.0, 0.2}) {
            RawMesh raw;
            add_cone(raw, 60, 0.0, 80.0, 0.0);
            add_cone(raw, 87, -gap, -50.0, 0.01);
            const SurfaceMesh surface = weld(raw);
            CHECK(border_edges(surface) == 0);
            CHECK(count_of(surface, "gaps_closed") + count_of(surface, "t_junctions_closed") ==
                  doctest::Approx(147.0).epsilon(0.5));
            WeldOptions never;
            never.stitch_mm = 0.0;
            CHECK(border_edges(weld(raw, never)) == 147);
        }
        RawMesh far;
        add_cone(far, 60, 0.0, 80.0, 0.0);
        add_cone(far, 87, -5.0, -50.0, 0.01);
        CHECK(border_edges(weld(far)) == 147);
    }

    TEST_CASE("patches that meet for a part of their way only are stitched, fine beside coarse") {
        // A long strip in 4 cells, and two short ones at its right side, one of them so fine that
        // its border vertices are nearer to each other than the gap may be wide.
        RawMesh raw;
        const auto add_patch = [&](double x, double y, double width, double height, int columns,
                                   int rows) {
            const auto first = static_cast<Index>(raw.positions.size());
            for (int j = 0; j <= rows; ++j) {
                for (int i = 0; i <= columns; ++i)
                    raw.positions.emplace_back(x + width * i / columns, y + height * j / rows,
                                               0.3 * std::sin(0.1 * y + 0.1 * height * j / rows));
            }
            for (int j = 0; j < rows; ++j) {
                for (int i = 0; i < columns; ++i) {
                    const Index a = first + j * (columns + 1) + i, b = a + columns + 1;
                    raw.triangles.push_back({a, a + 1, b + 1});
                    raw.triangles.push_back({a, b + 1, b});
                }
            }
        };
        add_patch(0, 0, 20, 40, 1, 4);
        add_patch(20.1, 0, 20, 19.95, 4, 80);
        add_patch(20.1, 20.05, 20, 19.95, 4, 3);
        raw.triangle_labels.assign(raw.triangles.size(), 0);
        raw.label_sets = {{}};
        WeldOptions options;
        options.unit_mm = 1.0;
        options.stitch_mm = 0.3;
        const SurfaceMesh surface = weld(raw, options);
        CHECK(count_of(surface, "gaps_closed") > 0);
        CHECK(count_of(surface, "t_junctions_closed") > 0);
        // The free sides of all three: left, above and below, right.
        CHECK(border_edges(surface) == 4 + 2 * (1 + 4) + 80 + 3);
        double area = 0.0;
        for (const auto face : surface.mesh.faces()) area += surface.mesh.calc_face_area(face);
        CHECK(area == doctest::Approx(40.1 * 40.0).epsilon(0.01));
        options.stitch_mm = 0.05;  // narrower than the gaps
        CHECK(border_edges(weld(raw, options)) == 10 + 168 + 14);
    }

    TEST_CASE("a coarse face beside finer ones is split where they meet") {
        RawMesh raw = load_model(
            "v 0 0 0\nv 8 0 0\nv 4 6 0\nv 0 0 0\nv 4 -6 0\nv 2 0 0\nv 8 0 0\nf 1 2 3\nf 4 5 6\nf 6 "
            "5 7\n");
        raw.indexed = false;
        const SurfaceMesh surface = weld(raw);
        CHECK(count_of(surface, "t_junctions_closed") == 1);
        CHECK(surface.mesh.n_faces() == 4);
        CHECK(border_edges(surface) == 4);
    }

    TEST_CASE("two open halves that touch stay two, unless asked") {
        const std::string halves =
            "v 0 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\nf 1 2 3\nf 1 3 4\nv 9 0 0\nv 18 0 0\nv 18 9 0\nv "
            "9 9 "
            "0\nf 5 6 7\nf 5 7 8\n";
        CHECK(border_edges(welded(halves)) == 8);
    }

    TEST_CASE("the unit is guessed for a last, and said") {
        for (const auto& [scale, unit] : {std::pair(1.0, 1.0), std::pair(0.1, 10.0),
                                          std::pair(0.001, 1000.0), std::pair(1 / 25.4, 25.4)}) {
            RawMesh raw;
            add_cone(raw, 60, 0.0, 80.0, 0.0);
            add_cone(raw, 60, 0.0, -50.0, 0.0);
            for (Vec3& p : raw.positions) p = scale * Vec3(1.3 * p.x(), p.y(), p.z());
            const SurfaceMesh surface = weld(raw);
            CHECK(surface.unit_mm == unit);
            CHECK(surface.warnings.size() == (unit == 1.0 ? 0 : 1));
            WeldOptions said;
            said.unit_mm = 2.0;
            CHECK(weld(raw, said).unit_mm == 2.0);
        }
    }
}

}  // namespace lastflat
