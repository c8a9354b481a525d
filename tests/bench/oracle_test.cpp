// CGAL as an oracle: the same method, the same border, the same map; the same distances.
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "core/border/convex_border.h"
#include "core/cut/cut.h"
#include "core/cut/insert_curves.h"
#include "core/geodesic/exact_geodesics.h"
#include "core/load/load_model.h"
#include "core/parameterize/fixed_border.h"
#include "core/weld/weld.h"
#include "tests/bench/peers.h"
#include "tests/helpers/face.h"
#include "tests/helpers/sample.h"

namespace lastflat {
namespace {

std::vector<Region> sample_halves() {
    const SampleLast last = make_sample_last();
    std::vector<Region> halves;
    for (auto& flat : test::flatten_sample(last, test::sample_options(last)).regions)
        halves.push_back(std::move(flat.region));
    return halves;
}

double largest_difference(const Points2& a, const Points2& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).norm());
    return largest;
}

double size_of(const Points2& border) {
    double largest = 0;
    for (const Vec2& p : border) largest = std::max(largest, p.norm());
    return largest;
}

void check_distances(const Region& region, Index source) {
    const auto ours = ExactGeodesics(region).from_vertex(source, Progress()).distance;
    const auto theirs = peers::CgalMesh(region).distances_from(source);
    double worst = 0;
    for (std::size_t v = 0; v < ours.size(); ++v) {
        if (static_cast<Index>(v) == source) continue;
        worst = std::max(worst, std::abs(ours[v] / theirs[v] - 1));
    }
    CAPTURE(region.name);
    CHECK(worst < 1e-9);
}

}  // namespace

TEST_SUITE("oracle") {
    TEST_CASE("mean value, tutte and harmonic maps on a circle are CGAL's") {
        auto regions = sample_halves();
        regions.push_back(test::face());
        for (const Region& region : regions) {
            const Points2 border = circle_border(region);
            peers::CgalMesh cgal(region);
            const double bound = 1e-8 * size_of(border);
            CHECK(largest_difference(flatten_fixed_border(region, mean_value_weights, border).uv,
                                     cgal.mean_value(border)) < bound);
            CHECK(largest_difference(flatten_fixed_border(region, tutte_weights, border).uv,
                                     cgal.tutte(border)) < bound);
            CHECK(largest_difference(flatten_fixed_border(region, harmonic_weights, border).uv,
                                     cgal.harmonic(border)) < bound);
        }
    }

    TEST_CASE("geodesic distances are CGAL's exact ones") {
        for (const Region& region : sample_halves()) {
            check_distances(region, 1000);
            check_distances(region, region.border[10]);
        }
        check_distances(test::face(), 777);
    }

    TEST_CASE("curves that are shortest paths are as long as CGAL's") {
        const SampleLast last = make_sample_last();
        WeldOptions options;
        options.unit_mm = 1.0;
        SurfaceMesh surface = weld(last.mesh, options);
        Triangulation whole{last.mesh.positions, last.mesh.triangles};
        Region region;
        static_cast<Triangulation&>(region) = whole;
        peers::CgalMesh cgal(region);
        std::vector<PointSource> points;
        std::vector<CurveSource> curves;
        const auto count = static_cast<Index>(whole.positions.size());
        for (Index i = 0; i < 6; ++i) {
            const std::string number = std::to_string(i);
            points.push_back({"from" + number, (count / 7 * i + 11) % count});
            points.push_back({"to" + number, (count / 5 * i + count / 2) % count});
            curves.push_back({"curve" + number, ShortestPath{{"from" + number, "to" + number}}});
        }
        const auto inserted = insert_curves(surface, locate_curves(surface, curves, points)).curves;
        for (std::size_t i = 0; i < inserted.size(); ++i) {
            double length = 0;
            const auto& path = inserted[i].vertices;
            for (std::size_t k = 1; k < path.size(); ++k)
                length += (surface.position(path[k]) - surface.position(path[k - 1])).norm();
            const Index from = std::get<Index>(points[2 * i].location);
            const Index to = std::get<Index>(points[2 * i + 1].location);
            const double theirs = cgal.distances_from(from)[at(to)];
            CHECK(length == doctest::Approx(theirs).epsilon(1e-9));
        }
    }

    TEST_CASE("geodesic distances on a scanned face are CGAL's exact ones") {
        const char* given = std::getenv("LASTFLAT_MESHES");
        const char* source = std::getenv("LASTFLAT_SOURCE");
        const auto folder = given != nullptr
                                ? std::filesystem::path(given)
                                : std::filesystem::path(source != nullptr ? source : ".") / ".." /
                                      "shared" / "meshes";
        std::ifstream file(folder / "bff_face.obj", std::ios::binary);
        if (!file) {
            std::cout << "skipped: no folder with bff_face.obj (LASTFLAT_MESHES)" << std::endl;
            return;
        }
        const std::string bytes{std::istreambuf_iterator<char>(file), {}};
        const auto regions = cut_into_regions(weld(load_model(bytes), {}), {}, {});
        check_distances(regions[0], 8581);
        check_distances(regions[0], regions[0].border[5]);
    }
}

}  // namespace lastflat
