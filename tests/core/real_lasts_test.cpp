// Real lasts against the best known optimum. Their files are not part of the project: the folder is
// named by LASTFLAT_LASTS (default: shared/lasts beside the source), and without it the test says
// that it was skipped.
#include <doctest/doctest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "api/flatten_request.h"
#include "core/flatten.h"
#include "core/landmarks/edge_line.h"
#include "core/landmarks/landmarks.h"
#include "core/load/load_model.h"
#include "core/prepare.h"
#include "core/weld/weld.h"
#include "tests/helpers/curve_distance.h"

namespace lastflat {
namespace {

namespace fs = std::filesystem;

fs::path folder() {
    if (const char* given = std::getenv("LASTFLAT_LASTS")) return given;
    const char* source = std::getenv("LASTFLAT_SOURCE");
    return fs::path(source != nullptr ? source : ".") / ".." / "shared" / "lasts";
}

bool skipped() {
    if (fs::is_directory(folder())) return false;
    std::cout << "skipped: no folder of real lasts (LASTFLAT_LASTS)" << std::endl;
    return true;
}

std::string bytes_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    REQUIRE(file.good());
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string without_groups(const std::string& obj) {
    std::string text;
    std::istringstream lines(obj);
    for (std::string line; std::getline(lines, line);) {
        if (line.rfind("g ", 0) != 0) text += line + "\n";
    }
    return text;
}

/// The same shape in about so many triangles.
RawMesh coarser(const RawMesh& fine, std::size_t triangles) {
    std::vector<float> positions;
    std::vector<unsigned> indices;
    for (const Vec3& p : fine.positions) {
        for (const double c : p) positions.push_back(static_cast<float>(c));
    }
    for (const Triangle& t : fine.triangles) {
        for (const Index v : t) indices.push_back(static_cast<unsigned>(v));
    }
    std::vector<unsigned> kept(indices.size());
    kept.resize(meshopt_simplify(kept.data(), indices.data(), indices.size(), positions.data(),
                                 fine.positions.size(), 3 * sizeof(float), 3 * triangles, 1.0F));
    RawMesh coarse = fine;
    coarse.triangles.clear();
    for (std::size_t i = 0; i < kept.size(); i += 3) {
        coarse.triangles.push_back({static_cast<Index>(kept[i]), static_cast<Index>(kept[i + 1]),
                                    static_cast<Index>(kept[i + 2])});
    }
    coarse.triangle_labels.assign(coarse.triangles.size(), 0);
    return coarse;
}

FlattenResult flatten_last(const std::string& name, std::size_t threads = 2) {
    FlattenOptions options;
    options.request =
        api::flatten_request_from_json(bytes_of(folder() / (name + ".request.json"))).asked;
    options.threads = threads;
    Progress progress;
    return flatten(bytes_of(folder() / (name + ".obj")), options, progress);
}

/// Best known symmetric Dirichlet energy, normalised L2 stretch and largest stretch, every edge of
/// centre front and heel locked.
struct Optimum {
    const char* name;
    double dirichlet, l2_normalised, linf;
};
constexpr Optimum lateral[] = {{"donna_t30_size38", 1.000575, 1.000424, 1.0764},
                               {"uomo_t10_size42", 1.000537, 1.000395, 1.0725}};
constexpr Optimum medial[] = {{"donna_t30_size38", 1.000831, 1.000613, 1.0850},
                              {"uomo_t10_size42", 1.000552, 1.000408, 1.0699}};

void check_optimum(const FlatRegion& flat, const Optimum& best) {
    CAPTURE(best.name);
    CAPTURE(flat.region.name);
    CHECK(std::abs(flat.metrics.symmetric_dirichlet - best.dirichlet) <
          0.0000015);  // its last digit
    CHECK(std::abs(flat.metrics.stretch_l2_normalised - best.l2_normalised) < 0.0000015);
    CHECK(std::abs(flat.metrics.stretch_linf - best.linf) < 0.0002);
    CHECK(flat.metrics.flipped_triangles == 0);
    CHECK(flat.metrics.border_crossings == 0);
    for (const CurveReport& curve : flat.curves) {
        if (curve.locked) CHECK(curve.worst_edge_error_mm < 1e-9);
    }
}

}  // namespace

TEST_SUITE("core/real_lasts") {
    TEST_CASE("halves reach the best known optimum with every locked edge exact") {
        if (skipped()) return;
        for (std::size_t i = 0; i < 2; ++i) {
            check_optimum(
                flatten_last(std::string(lateral[i].name) + "_upper_lateral_half").regions[0],
                lateral[i]);
            check_optimum(
                flatten_last(std::string(medial[i].name) + "_upper_medial_half").regions[0],
                medial[i]);
        }
    }

    TEST_CASE("closed lasts are cut into the same halves") {
        if (skipped()) return;
        for (std::size_t i = 0; i < 2; ++i) {
            const FlattenResult result = flatten_last(std::string(lateral[i].name) + "_closed");
            REQUIRE(result.regions.size() == 2);
            check_optimum(result.regions[0], lateral[i]);
            check_optimum(result.regions[1], medial[i]);
            REQUIRE(result.pairs.size() == 2);
            for (const PairReport& pair : result.pairs) CHECK(std::abs(pair.difference_mm) < 1e-3);
        }
    }

    TEST_CASE("the slit of an upper stays a slit; welded shut, it is opened there again") {
        if (skipped()) return;
        Progress progress;
        const FlattenResult result =
            flatten(bytes_of(folder() / "uomo_t10_size42_upper_disk_10k.obj"), {}, progress);
        REQUIRE(result.regions.size() == 1);
        CHECK(result.regions[0].metrics.flipped_triangles == 0);
        FlattenOptions welded;
        welded.request.weld.tolerance_mm = 0.0;
        const FlattenResult ring =
            flatten(bytes_of(folder() / "uomo_t10_size42_upper_disk_10k.obj"), welded, progress);
        REQUIRE(result.regions.size() == 1);
        CHECK(ring.warnings.at(0).code == "seam_added");
        CHECK(*ring.regions[0].energy == doctest::Approx(*result.regions[0].energy).epsilon(1e-4));
        REQUIRE(ring.pairs.size() == 1);
        CHECK(std::abs(ring.pairs[0].difference_mm) < 1e-6);
    }

    TEST_CASE("the seam that opens a whole upper is the heel's, to a fraction of a millimetre") {
        if (skipped()) return;
        for (const char* name : {"donna_t30_size38", "uomo_t10_size42"}) {
            CAPTURE(name);
            const std::string model = bytes_of(folder() / (std::string(name) + "_closed.obj"));
            FlattenOptions options;
            options.request.weld.groups = {"upper"};
            Progress progress;
            const FlattenResult found = flatten(model, options, progress);
            const FlattenResult with_true_curves = flatten_last(std::string(name) + "_closed");
            const auto heel =
                std::find_if(with_true_curves.pairs.begin(), with_true_curves.pairs.end(),
                             [](const PairReport& p) { return p.curve == "heel"; });
            REQUIRE(heel != with_true_curves.pairs.end());
            REQUIRE(found.pairs.size() == 1);
            CHECK(std::abs(found.pairs[0].length_mm - heel->length_mm) < 0.2);
            CHECK(std::abs(found.pairs[0].difference_mm) < 1e-6);
            CHECK(found.regions[0].metrics.flipped_triangles == 0);
            CHECK(found.regions[0].metrics.border_crossings == 0);
        }
    }

    TEST_CASE("a bare last: its curves, sides and foot are found, and its halves are as good") {
        if (skipped()) return;
        for (std::size_t n = 0; n < 2; ++n) {
            const std::string name = lateral[n].name;
            CAPTURE(name);
            const std::string bytes = bytes_of(folder() / (name + "_closed.obj"));
            const Request request =
                api::flatten_request_from_json(bytes_of(folder() / (name + "_closed.request.json")))
                    .asked;
            const RawMesh raw = load_model(bytes);
            Progress progress;
            const FlattenResult result = flatten(without_groups(bytes), {}, progress);
            REQUIRE(result.plan.landmarks.has_value());
            CHECK(result.plan.landmarks->foot == Foot::right);
            const auto any_points_of = [&](const CurveSource& curve) {
                if (const auto* line = std::get_if<Polyline>(&curve.form)) return line->points;
                Points3 points;
                for (const Index v : std::get<VertexPath>(curve.form).vertices)
                    points.push_back(raw.positions[at(v)]);
                return points;
            };
            for (const CurveSource& curve : result.plan.request.curves) {
                const Points3 found = any_points_of(curve);
                Points3 truth;
                for (const CurveSource& known : request.curves) {
                    if (known.name == curve.name) truth = any_points_of(known);
                }
                const auto there = test::distance_between(truth, found);
                const auto back = test::distance_between(found, truth);
                const bool closed = curve.name == "featherline" || curve.name == "topline";
                CAPTURE(curve.name);
                CHECK(std::max(there.mean, back.mean) < (closed ? 1.0 : 1.5));
                CHECK(std::max(there.most, back.most) < 3.0);
            }
            REQUIRE(result.regions.size() == 2);
            for (std::size_t side = 0; side < 2; ++side) {
                const double best = (side == 0 ? lateral : medial)[n].dirichlet - 1.0;
                const double ours = result.regions[side].metrics.symmetric_dirichlet - 1.0;
                CHECK(std::abs(ours / best - 1.0) < 0.05);
            }
        }
    }

    TEST_CASE("a bare last is found through the noise of a scan and in coarse triangles") {
        if (skipped()) return;
        for (const Optimum& best : lateral) {
            CAPTURE(best.name);
            RawMesh raw = load_model(
                without_groups(bytes_of(folder() / (best.name + std::string("_closed.obj")))));
            const SurfaceMesh clean = weld(raw);
            const Landmarks known = find_landmarks(clean);
            const auto check = [&](const RawMesh& changed, double mean, double most) {
                const SurfaceMesh surface = weld(changed);
                const Landmarks found = find_landmarks(surface);
                CHECK(found.foot == known.foot);
                CHECK(found.up.dot(known.up) > 0.99);
                CHECK(found.forward.dot(known.forward) > 0.99);
                const auto off =
                    test::distance_between(points_of(found.curves[0]), points_of(known.curves[0]));
                if (found.featherline_confidence < mostly_sharp) return;  // it has been said
                CHECK(off.mean < mean);
                CHECK(off.most < most);
            };
            check(coarser(raw, 1000), 2.0, 6.0);
            std::mt19937 random(11);
            std::normal_distribution<double> noise(0.0, 0.1);
            for (Vec3& p : raw.positions) p += Vec3(noise(random), noise(random), noise(random));
            check(raw, 0.7, 4.0);
        }
    }

    TEST_CASE(
        "a factory's export with all its dirt is one closed last, and its maker's lines lie on "
        "it") {
        if (skipped()) return;
        const auto lines =
            nlohmann::json::parse(bytes_of(folder() / "factory_38_with_lugs.curves.json"));
        FlattenOptions options;
        for (const std::string name : {"featherline", "topline"}) {
            Polyline line;
            for (const auto& p : lines[name]["polyline"])
                line.points.emplace_back(p[0], p[1], p[2]);
            options.request.curves.push_back({name, line});
        }
        options.request.weld.unit_mm = 1.0;
        Progress progress;
        const ReadModel read =
            read_model(bytes_of(folder() / "factory_38_with_lugs.obj"), options, progress);
        for (const auto edge : read.surface.mesh.edges())
            REQUIRE_FALSE(read.surface.mesh.is_boundary(edge));
        const auto located = locate_curves(read.surface, options.request.curves);
        for (const SurfaceLine& line : located) {
            double length = 0.0;
            for (std::size_t i = 1; i < line.points.size(); ++i)
                length += (position_of(read.surface, line.points[i]) -
                           position_of(read.surface, line.points[i - 1]))
                              .norm();
            const double asked = lines[line.name]["length_mm"];
            CAPTURE(line.name);
            CHECK(std::abs(length / asked - 1.0) < 0.01);
        }
    }

    TEST_CASE(
        "a CAD export in patches with gaps is one closed last, and is flattened as it comes") {
        if (skipped()) return;
        Progress progress;
        const FlattenResult result =
            flatten(bytes_of(folder() / "uomo_t10_size42_raw_rhino_rendermesh.obj"), {}, progress);
        CHECK(result.regions.size() == 2);
        CHECK(result.repairs.size() == 3);
    }
}

}  // namespace lastflat
