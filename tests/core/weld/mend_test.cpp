// Faults that are mended on a whole last: the surface afterwards is the one without the fault.
#include <doctest/doctest.h>

#include <set>

#include "core/load/load_model.h"
#include "core/numerics/geometry.h"
#include "core/sample/sample_last.h"
#include "core/weld/weld.h"

namespace lastflat {
namespace {

const Repair* repair_of(const SurfaceMesh& surface, const std::string& code) {
    for (const Repair& repair : surface.repairs) {
        if (repair.code == code) return &repair;
    }
    return nullptr;
}

bool is_closed_surface(const SurfaceMesh& surface) {
    for (const auto edge : surface.mesh.edges()) {
        if (surface.mesh.is_boundary(edge)) return false;
    }
    return true;
}

void remove_triangle(RawMesh& mesh, std::size_t t) {
    mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(t));
    mesh.triangle_labels.erase(mesh.triangle_labels.begin() + static_cast<std::ptrdiff_t>(t));
}

/// The triangles for which it is true get vertices of their own, moved by an offset.
template <class Choice>
void detach(RawMesh& mesh, const Vec3& offset, const Choice& choice) {
    const std::size_t count = mesh.positions.size();
    for (std::size_t v = 0; v < count; ++v) mesh.positions.push_back(mesh.positions[v] + offset);
    for (Triangle& t : mesh.triangles) {
        if (!choice(mesh.positions[at(t[0])])) continue;
        for (Index& v : t) v += static_cast<Index>(count);
    }
}

bool is_in_front(const Vec3& p) {
    return p.x() > 120.0;
}

std::size_t used_vertices(const SurfaceMesh& surface) {
    std::set<int> used;
    for (const auto v : surface.mesh.vertices()) {
        if (!surface.mesh.is_isolated(v)) used.insert(v.idx());
    }
    return used.size();
}

const RawMesh& whole() {
    static const RawMesh mesh = make_sample_last().mesh;
    return mesh;
}

}  // namespace

TEST_SUITE("core/weld/mend") {
    TEST_CASE("small holes of a closed last are closed, and said with position and length") {
        RawMesh holed = whole();
        const Triangle missing = holed.triangles[5000];
        remove_triangle(holed, 5000);
        const SurfaceMesh surface = weld(holed);
        CHECK(is_closed_surface(surface));
        CHECK(surface.mesh.n_faces() == whole().triangles.size());
        const Repair* repair = repair_of(surface, "holes_closed");
        REQUIRE(repair != nullptr);
        CHECK(repair->count == 1);
        const auto p = [&](std::size_t i) { return whole().positions[at(missing[i])]; };
        CHECK((repair->positions.at(0) - (p(0) + p(1) + p(2)) / 3.0).norm() < 1e-9);
        CHECK(repair->lengths_mm.at(0) ==
              doctest::Approx((p(1) - p(0)).norm() + (p(2) - p(1)).norm() + (p(0) - p(2)).norm()));
        CHECK_FALSE(is_closed_surface(weld(holed, {}, HoleRule::keep)));
    }

    TEST_CASE("an opening as large as a topline is no small hole") {
        RawMesh open = whole();
        double top = 0.0;
        for (const Vec3& p : open.positions) top = std::max(top, p.z());
        for (std::size_t t = open.triangles.size(); t-- > 0;) {
            if (open.positions[at(open.triangles[t][0])].z() > top - 5.0) remove_triangle(open, t);
        }
        CHECK_FALSE(is_closed_surface(weld(open)));
    }

    TEST_CASE("two holes that meet in a vertex are two, and the vertex stays one") {
        RawMesh holed = whole();
        const Triangle first = holed.triangles[5000];
        std::size_t second = 0;
        for (std::size_t t = 0; t < holed.triangles.size(); ++t) {
            int common = 0;
            for (const Index v : holed.triangles[t])
                common += std::count(first.begin(), first.end(), v) > 0 ? 1 : 0;
            if (common == 1) second = t;
        }
        remove_triangle(holed, std::max<std::size_t>(second, 5000));
        remove_triangle(holed, std::min<std::size_t>(second, 5000));
        const SurfaceMesh surface = weld(holed);
        CHECK(is_closed_surface(surface));
        CHECK(repair_of(surface, "holes_closed")->count == 2);
        CHECK(repair_of(surface, "vertices_split") == nullptr);
        CHECK(used_vertices(surface) == used_vertices(weld(whole())));
    }

    TEST_CASE("parts that share one vertex get one each") {
        const SurfaceMesh surface =
            weld(load_model("v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nf 1 2 3\nf 1 4 5\n"));
        CHECK(used_vertices(surface) == 6);
        CHECK(surface.copies == std::vector<Index>{0});
        REQUIRE(repair_of(surface, "vertices_split") != nullptr);
        CHECK(repair_of(surface, "vertices_split")->positions.at(0) == Vec3::Zero());
    }

    TEST_CASE("a group that touches itself in a vertex is parted there, with the labels beyond") {
        RawMesh sheet;  // 2 x 2 cells; "a" has two that meet in the middle
        sheet.label_sets = {{"a"}, {"b"}};
        for (int v = 0; v < 9; ++v) sheet.positions.emplace_back(40.0 * (v % 3), 40.0 * (v / 3), 0);
        for (const Index corner : {0, 1, 3, 4}) {
            sheet.triangles.push_back({corner, corner + 1, corner + 4});
            sheet.triangles.push_back({corner, corner + 4, corner + 3});
            const std::uint32_t label = corner == 0 || corner == 4 ? 0 : 1;
            sheet.triangle_labels.insert(sheet.triangle_labels.end(), 2, label);
        }
        WeldOptions options;
        options.groups = {"a"};
        const SurfaceMesh surface = weld(sheet, options);
        CHECK(used_vertices(surface) == 8);
        REQUIRE(repair_of(surface, "vertices_split") != nullptr);
        CHECK(repair_of(surface, "vertices_split")->count == 1);
        std::size_t beyond = 0;
        for (const auto h : surface.mesh.halfedges()) {
            if (surface.mesh.is_boundary(h)) beyond += surface.label_at(h) == 1U ? 1 : 0;
        }
        CHECK(beyond == 4);
    }

    TEST_CASE("two solids that touch along an edge stay two solids") {
        // Two tetrahedra on both sides of the edge 0 1, which has four faces.
        const SurfaceMesh surface = weld(
            load_model("v 0 0 0\nv 0 0 2\nv 2 1 1\nv 2 -1 1\nv -2 1 1\nv -2 -1 1\n"
                       "f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\nf 1 5 2\nf 1 2 6\nf 1 6 5\nf 2 5 6\n"));
        CHECK(is_closed_surface(surface));
        CHECK(used_vertices(surface) == 8);
        for (const auto face : surface.mesh.faces()) {  // none has corners of both
            double side = 0.0;
            for (const auto v : surface.mesh.fv_range(face)) {
                const double x = surface.position(v.idx()).x();
                CHECK(side * x >= 0.0);
                side += x;
            }
        }
    }

    TEST_CASE("a wall without thickness goes, one of two equal faces stays") {
        RawMesh walled = whole();
        // From an edge inwards, there and back.
        const Triangle t = walled.triangles[5000];
        const auto inner = static_cast<Index>(walled.positions.size());
        walled.positions.emplace_back(140.0, 0.0, 30.0);
        for (const Triangle& wall : {Triangle{t[0], t[1], inner}, Triangle{t[1], t[0], inner}}) {
            walled.triangles.push_back(wall);
            walled.triangle_labels.push_back(walled.triangle_labels[5000]);
        }
        const SurfaceMesh surface = weld(walled);
        CHECK(is_closed_surface(surface));
        CHECK(surface.mesh.n_faces() == whole().triangles.size());
        CHECK(repair_of(surface, "duplicate_faces_dropped")->count == 2);
        RawMesh repeated = whole();
        repeated.triangles.push_back({t[0], t[2], t[1]});
        repeated.triangle_labels.push_back(repeated.triangle_labels[5000]);
        CHECK(weld(repeated).mesh.n_faces() == whole().triangles.size());
        const RawMesh sheet =
            load_model("v 0 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\nf 1 2 3\nf 1 3 4\nf 1 3 2\nf 1 4 3\n");
        CHECK(weld(sheet).mesh.n_faces() == 2);
    }

    TEST_CASE(
        "an export's dirt goes, and the solid is what it was: a folded strip, a fin, a crack") {
        RawMesh dirty = whole();
        const std::size_t clean_vertices = used_vertices(weld(whole()));
        const auto add = [&](Index a, Index b, Index c) {
            dirty.triangles.push_back({a, b, c});
            dirty.triangle_labels.push_back(0);
        };
        const auto add_vertex = [&](const Vec3& p) {
            dirty.positions.push_back(p);
            return static_cast<Index>(dirty.positions.size()) - 1;
        };
        // A flap without thickness on one edge, as two triangles back to back.
        const Triangle on = dirty.triangles[1000];
        const Vec3 middle = centroid(weld(whole()), on);
        const Index tip = add_vertex(middle + Vec3(0.0, 0.0, 0.5));
        add(on[0], on[1], tip);
        add(on[1], on[0], tip);
        // A single triangle that stands on another edge.
        const Triangle under = dirty.triangles[3000];
        add(under[0], under[1], add_vertex(dirty.positions[at(under[2])] + Vec3(0.0, 0.0, 2.0)));
        // A crack: two triangles get a corner of their own, 0.005 mm off.
        const Index moved = dirty.triangles[5000][0];
        const Index twin = add_vertex(dirty.positions[at(moved)] + Vec3(0.005, 0.0, 0.0));
        std::size_t apart = 0;
        for (Triangle& t : dirty.triangles) {
            for (Index& v : t) {
                if (v == moved && apart < 2) {
                    v = twin;
                    ++apart;
                }
            }
        }
        REQUIRE(apart == 2);
        const SurfaceMesh surface = weld(dirty);
        CHECK(is_closed_surface(surface));
        CHECK(used_vertices(surface) <= clean_vertices + 1);
        CHECK(used_vertices(surface) >= clean_vertices);
        REQUIRE(repair_of(surface, "fins_dropped") != nullptr);
        CHECK(repair_of(surface, "fins_dropped")->count == 1);
        CHECK(repair_of(surface, "faces_turned") == nullptr);
    }

    TEST_CASE(
        "of two small patches on one edge the fin goes, not the face that a crack has loosened") {
        RawMesh mesh = whole();
        const Triangle t = mesh.triangles[2500];
        mesh.positions.push_back(mesh.positions[at(t[2])] + Vec3(0.004, 0.0, 0.0));
        mesh.positions.push_back(mesh.positions[at(t[2])] + Vec3(0.0, 0.0, 3.0));
        const auto tip = static_cast<Index>(mesh.positions.size()) - 1;
        mesh.triangles[2500] = {t[0], t[1], tip - 1};
        mesh.triangles.push_back({t[1], t[0], tip});
        mesh.triangle_labels.push_back(0);
        const SurfaceMesh surface = weld(mesh);
        CHECK(is_closed_surface(surface));
        REQUIRE(repair_of(surface, "fins_dropped") != nullptr);
        CHECK(repair_of(surface, "fins_dropped")->count == 1);
    }

    TEST_CASE("the inner wall of a hollow print is left out, a second last beside it is not") {
        RawMesh hollow = whole();
        const std::size_t count = hollow.positions.size(), faces = hollow.triangles.size();
        Vec3 middle = Vec3::Zero();
        for (const Vec3& p : whole().positions) middle += p / static_cast<double>(count);
        const auto add_copy = [&](RawMesh& mesh, double scale, const Vec3& offset) {
            for (std::size_t v = 0; v < count; ++v)
                mesh.positions.push_back(middle + scale * (mesh.positions[v] - middle) + offset);
            for (std::size_t t = 0; t < faces; ++t) {
                const Triangle& outer = mesh.triangles[t];
                const auto first = static_cast<Index>(count);
                mesh.triangles.push_back({outer[0] + first, outer[2] + first, outer[1] + first});
                mesh.triangle_labels.push_back(0);
            }
        };
        RawMesh pair = hollow;
        add_copy(hollow, 0.8, Vec3::Zero());
        add_copy(pair, 0.8, Vec3(0.0, 150.0, 0.0));
        const SurfaceMesh surface = weld(hollow);
        CHECK(surface.mesh.n_faces() == faces);
        REQUIRE(repair_of(surface, "inner_shells_dropped") != nullptr);
        CHECK(repair_of(surface, "inner_shells_dropped")->count == 1);
        CHECK(weld(pair).mesh.n_faces() == 2 * faces);
    }

    TEST_CASE("a few faces that wind wrongly are turned, the rest is not turned with them") {
        RawMesh mesh = whole();
        for (const std::size_t t : {100, 101, 2000})
            std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
        const SurfaceMesh surface = weld(mesh);
        REQUIRE(repair_of(surface, "faces_turned") != nullptr);
        CHECK(repair_of(surface, "faces_turned")->count == 3);
        CHECK(repair_of(surface, "orientation_reversed") == nullptr);
    }

    TEST_CASE("a seam of texture is joined and listed, unless it is kept") {
        RawMesh seamed = whole();
        seamed.repeats_at_seams = true;
        detach(seamed, Vec3::Zero(), is_in_front);
        const SurfaceMesh surface = weld(seamed);
        CHECK(is_closed_surface(surface));
        const Repair* repair = repair_of(surface, "seams_joined");
        REQUIRE(repair != nullptr);
        CHECK(repair->count == 1);
        CHECK(repair->lengths_mm.at(0) > 150.0);  // around the ball
        WeldOptions keep;
        keep.coincident = Coincident::keep;
        keep.stitch_mm = 0.0;
        CHECK_FALSE(is_closed_surface(weld(seamed, keep)));
        RawMesh sheet =
            load_model("v 0 0 0\nv 9 0 0\nv 9 9 0\nv 9 0 0\nv 18 0 0\nv 9 9 0\nf 1 2 3\nf 4 5 6\n");
        CHECK(used_vertices(weld(sheet)) == 6);  // OBJ: two pieces are meant
        sheet.repeats_at_seams = true;
        CHECK(used_vertices(weld(sheet)) == 4);
    }

    TEST_CASE("gaps of any width give the same closed last, indexed or per facet with round-off") {
        for (const double gap : {1e-6, 1e-4, 3e-4, 1e-3, 1e-2, 0.1}) {
            CAPTURE(gap);
            RawMesh patches = whole();
            detach(patches, Vec3(0.6 * gap, 0.8 * gap, 0.0), is_in_front);
            CHECK(is_closed_surface(weld(patches)));
            RawMesh soup = patches;
            soup.indexed = false;
            soup.positions.clear();
            for (Triangle& t : soup.triangles) {
                for (Index& v : t) {
                    const Vec3 p = patches.positions[at(v)];
                    v = static_cast<Index>(soup.positions.size());
                    soup.positions.push_back(p.cast<float>().cast<double>());
                }
            }
            const SurfaceMesh surface = weld(soup);
            CHECK(is_closed_surface(surface));
            CHECK(used_vertices(surface) == used_vertices(weld(whole())));
        }
    }

    TEST_CASE("a gap that is wider than what is closed unasked is told, with what closes it") {
        RawMesh gap = whole();
        detach(gap, {0.9, 0.0, 0.0}, is_in_front);
        const SurfaceMesh surface = weld(gap);
        REQUIRE(surface.warnings.size() == 1);
        CHECK(surface.warnings[0].code == "gaps_left");
        CHECK(surface.warnings[0].detail.find("2 pieces") != std::string::npos);
        CHECK(surface.warnings[0].detail.find("\"stitch_mm\": 1}") != std::string::npos);
        WeldOptions options;
        options.stitch_mm = 1.0;
        CHECK(is_closed_surface(weld(gap, options)));
        CHECK(weld(gap, options).warnings.empty());
        detach(gap, {9.0, 0.0, 0.0}, is_in_front);  // nothing would close that
        CHECK(weld(gap).warnings.empty());
    }

    TEST_CASE("a T-junction whose vertex lies exactly on the edge is stitched in every format") {
        const std::string strips =
            "v 0 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\nv 9 0 0\nv 18 0 0\nv 18 9 0\nv 9 9 0\nv 9 4 0\n"
            "f 1 2 3\nf 1 3 4\nf 5 6 9\nf 9 6 7\nf 9 7 8\n";
        for (const bool asked : {false, true}) {
            WeldOptions options;
            if (asked) options.stitch_mm = 0.1;
            const SurfaceMesh surface = weld(load_model(strips), options);
            CHECK(used_vertices(surface) == 7);
            CHECK(repair_of(surface, "t_junctions_closed") != nullptr);
        }
    }

    TEST_CASE("a small patch that touches the rest is no stray") {
        RawMesh patches = whole();
        const Vec3 centre = patches.positions[at(patches.triangles[5000][0])];
        detach(patches, Vec3(0.0, 0.02, 0.0),
               [&](const Vec3& p) { return (p - centre).norm() < 6.0; });
        const SurfaceMesh surface = weld(patches);
        CHECK(repair_of(surface, "strays_dropped") == nullptr);
        CHECK(is_closed_surface(surface));
        CHECK(surface.mesh.n_faces() == whole().triangles.size());
    }
}

}  // namespace lastflat
