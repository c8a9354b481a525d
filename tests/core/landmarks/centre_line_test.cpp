// The found centre line is the section itself, whatever the triangles are.
#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>

#include "core/cut/cut_surface.h"
#include "core/export/write_model.h"
#include "core/flatten.h"
#include "core/locate/surface_search.h"
#include "core/numerics/geometry.h"
#include "core/plan/plan.h"
#include "core/sample/sample_last.h"
#include "core/weld/weld.h"
#include "tests/helpers/bare_sample.h"

namespace lastflat {
namespace {

struct Inserted {
    Points3 asked, got;  ///< the section, and the edges that it became
};

std::map<std::string, Inserted> centre_line(const RawMesh& raw) {
    Request request;
    SurfaceMesh surface = weld(raw, request.weld);
    const Plan plan = make_plan(surface, request);
    Progress progress;
    const CutSurface cut = cut_surface(surface, plan, progress);
    std::map<std::string, Inserted> lines;
    for (const CurveSource& source : plan.request.curves) {
        if (source.name == curve_name::centre_front || source.name == curve_name::heel)
            lines[source.name].asked = points_of(source);
    }
    for (const Curve& curve : cut.inserted.curves) {
        const auto line = lines.find(curve.name);
        if (line == lines.end()) continue;
        for (const Index v : curve.vertices) line->second.got.push_back(surface.position(v));
    }
    return lines;
}

/// All turns on the way, in radians.
double turning(const Points3& line) {
    double sum = 0.0;
    for (std::size_t i = 1; i + 1 < line.size(); ++i)
        sum += angle_between(line[i] - line[i - 1], line[i + 1] - line[i]);
    return sum;
}

/// Puts a vertex into an edge, at a position on it.
void split_edge(RawMesh& raw, Index a, Index b, const Vec3& position) {
    const auto middle = static_cast<Index>(raw.positions.size());
    raw.positions.push_back(position);
    for (std::size_t t = 0, count = raw.triangles.size(); t < count; ++t) {
        const Triangle old = raw.triangles[t];
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            if (std::minmax(old[i], old[j]) != std::minmax(a, b)) continue;
            raw.triangles[t][j] = middle;
            raw.triangles.push_back(old);
            raw.triangles.back()[i] = middle;
            raw.triangle_labels.push_back(raw.triangle_labels[t]);
        }
    }
}

}  // namespace

TEST_SUITE("core/landmarks/centre_line") {
    TEST_CASE("the edges of the found centre line are the section") {
        for (const auto& [name, line] : centre_line(test::bare_sample())) {
            CAPTURE(name);
            const Vec3 across = line.asked.back() - line.asked.front();
            const Vec3 normal =
                across.cross(line.asked[line.asked.size() / 2] - line.asked.front()).normalized();
            for (const Vec3& p : line.got)
                CHECK(std::abs(normal.dot(p - line.asked.front())) < 0.01);
            CHECK(line.got.size() > 20);
            CHECK(std::abs(length_of(line.got) - length_of(line.asked)) < 1e-3);
            CHECK(turning(line.got) < turning(line.asked) + std::numbers::pi / 180.0);
        }
    }

    TEST_CASE("its length does not depend on the triangulation") {
        const RawMesh coarse = test::bare_sample(), fine = test::subdivided(coarse);
        auto of_coarse = centre_line(coarse), of_fine = centre_line(fine);
        REQUIRE(of_coarse.size() == 2);
        for (const auto& [name, line] : of_coarse) {
            CAPTURE(name);
            CHECK(std::abs(length_of(line.got) - length_of(of_fine.at(name).got)) < 0.02);
        }
    }

    TEST_CASE("needles along it, as a CAD system leaves them, cost few steps") {
        RawMesh raw = test::bare_sample();
        const SurfaceMesh surface = weld(raw);
        const SurfaceSearch search(surface);
        for (const CurveSource& curve : find_landmarks(surface).curves) {
            const auto* line = std::get_if<Polyline>(&curve.form);
            if (line == nullptr) continue;
            for (std::size_t i = 1; i + 1 < line->points.size(); ++i) {
                const auto edge = search.nearest(line->points[i]).point.support();
                if (edge.size() != 2) continue;
                const Vec3 along = surface.position(edge[1]) - surface.position(edge[0]);
                split_edge(raw, edge[0], edge[1], line->points[i] + 1e-3 * along.normalized());
            }
        }
        REQUIRE(raw.positions.size() > surface.welded_to.size() + 100);
        Progress progress;
        const FlattenResult result = flatten(write_model_obj(raw), {}, progress);
        REQUIRE(result.regions.size() == 2);
        for (const FlatRegion& region : result.regions) {
            CHECK(region.iterations < 40);
            CHECK(region.projected_gradient < 1e-5);
        }
        for (const Warning& warning : result.warnings) CHECK(warning.code != "not_converged");
    }
}

}  // namespace lastflat
