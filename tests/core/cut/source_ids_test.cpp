#include "core/cut/source_ids.h"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <map>
#include <set>

#include "core/plan/plan.h"
#include "core/prepare.h"
#include "core/weld/weld.h"
#include "tests/helpers/bare_sample.h"

namespace lastflat {
namespace {

double area(const Points3& positions, const Triangle& t) {
    return 0.5 * (positions[at(t[1])] - positions[at(t[0])])
                     .cross(positions[at(t[2])] - positions[at(t[0])])
                     .norm();
}

/// A vertex for every corner, as flat-shaded models and STL have it.
RawMesh loose(const RawMesh& mesh) {
    RawMesh result = mesh;
    result.positions.clear();
    result.indexed = false;
    for (Triangle& t : result.triangles) {
        for (Index& v : t) {
            result.positions.push_back(mesh.positions[at(v)]);
            v = static_cast<Index>(result.positions.size()) - 1;
        }
    }
    return result;
}

struct Covered {
    double area = 0.0;
    std::set<Index> vertices;  ///< of the file
};

std::map<Index, Covered> covered_by(const Prepared& prepared) {
    std::map<Index, Covered> covered;
    for (const Region& region : prepared.regions) {
        REQUIRE(region.source_triangles.size() == region.triangles.size());
        for (std::size_t t = 0; t < region.triangles.size(); ++t) {
            Covered& source = covered[region.source_triangles[t]];
            source.area += area(region.positions, region.triangles[t]);
            for (const Index v : region.triangles[t]) {
                if (const auto id = prepared.sources.file_vertex(region.source_vertices[at(v)]))
                    source.vertices.insert(*id);
            }
        }
    }
    return covered;
}

}  // namespace

TEST_SUITE("core/cut/source_ids") {
    TEST_CASE("triangles of the file are covered by what names them, corner by corner") {
        RawMesh raw = loose(test::bare_sample());
        constexpr std::size_t missing = 4000, turned = 4100, twice = 4200;
        const double hole = area(raw.positions, raw.triangles[missing]);
        raw.triangles[missing] = raw.triangles[twice];  // closed by a face that nobody gave
        std::swap(raw.triangles[turned][0], raw.triangles[turned][1]);
        SurfaceMesh surface = weld(raw);
        Plan plan = make_plan(surface, Request{});
        Progress progress;
        const Prepared prepared = prepare(std::move(surface), std::move(plan), progress);

        std::map<Index, Covered> covered = covered_by(prepared);
        CHECK(prepared.sources.triangles == raw.triangles.size());
        CHECK(prepared.sources.vertices == raw.positions.size());
        CHECK(covered[-1].area == doctest::Approx(hole).epsilon(1e-9));
        covered.erase(-1);
        CHECK(covered.size() > 8000);
        CHECK(covered.contains(turned));
        CHECK(covered.contains(missing) + covered.contains(twice) == 1);
        std::size_t wrong_areas = 0, lost_corners = 0;
        for (const auto& [source, parts] : covered) {
            const Triangle& whole = raw.triangles[at(source)];
            const double expected = area(raw.positions, whole);
            wrong_areas += std::abs(parts.area - expected) > 1e-9 * expected ? 1 : 0;
            for (const Index v : whole)
                lost_corners += 1 - parts.vertices.count(prepared.sources.welded_to[at(v)]);
        }
        CHECK(wrong_areas == 0);
        CHECK(lost_corners == 0);
    }
}

}  // namespace lastflat
