// The found centre line is the section itself, whatever the triangles are.
#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>

#include "core/cut/cut_surface.h"
#include "core/numerics/geometry.h"
#include "core/plan/plan.h"
#include "core/sample/sample_last.h"
#include "core/weld/weld.h"

namespace lastflat {
namespace {

/// Every triangle becomes four in its own plane.
RawMesh subdivided(const RawMesh& coarse) {
    RawMesh fine = coarse;
    fine.triangles.clear();
    fine.triangle_labels.clear();
    std::map<std::pair<Index, Index>, Index> middles;
    const auto middle = [&](Index a, Index b) {
        const auto [found, is_new] = middles.try_emplace(std::minmax(a, b), -1);
        if (is_new) {
            found->second = static_cast<Index>(fine.positions.size());
            fine.positions.push_back(0.5 * (fine.positions[at(a)] + fine.positions[at(b)]));
        }
        return found->second;
    };
    for (std::size_t t = 0; t < coarse.triangles.size(); ++t) {
        const auto [a, b, c] = coarse.triangles[t];
        const Index x = middle(a, b), y = middle(b, c), z = middle(c, a);
        for (const Triangle& part :
             {Triangle{a, x, z}, Triangle{x, b, y}, Triangle{z, y, c}, Triangle{x, y, z}}) {
            fine.triangles.push_back(part);
            fine.triangle_labels.push_back(coarse.triangle_labels[t]);
        }
    }
    return fine;
}

RawMesh without_groups() {
    RawMesh raw = make_sample_last().mesh;
    raw.label_sets = {{}};
    raw.triangle_labels.assign(raw.triangles.size(), 0);
    return raw;
}

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
        if (const auto* line = std::get_if<Polyline>(&source.form))
            lines[source.name].asked = line->points;
    }
    for (const Curve& curve : cut.inserted.curves) {
        const auto line = lines.find(curve.name);
        if (line == lines.end()) continue;
        for (const Index v : curve.vertices) line->second.got.push_back(surface.position(v));
    }
    return lines;
}

double length_of(const Points3& line) {
    double length = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
    return length;
}

/// All turns on the way, in radians.
double turning(const Points3& line) {
    double sum = 0.0;
    for (std::size_t i = 1; i + 1 < line.size(); ++i)
        sum += angle_between(line[i] - line[i - 1], line[i + 1] - line[i]);
    return sum;
}

}  // namespace

TEST_SUITE("core/landmarks/centre_line") {
    TEST_CASE("the edges of the found centre line are the section") {
        for (const auto& [name, line] : centre_line(without_groups())) {
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
        const RawMesh coarse = without_groups(), fine = subdivided(coarse);
        auto of_coarse = centre_line(coarse), of_fine = centre_line(fine);
        REQUIRE(of_coarse.size() == 2);
        for (const auto& [name, line] : of_coarse) {
            CAPTURE(name);
            CHECK(std::abs(length_of(line.got) - length_of(of_fine.at(name).got)) < 0.02);
        }
    }
}

}  // namespace lastflat
