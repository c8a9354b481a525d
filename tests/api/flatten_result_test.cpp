#include "api/flatten_result.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "api/result_table.h"
#include "tests/helpers/sample.h"

namespace lastflat::api {
namespace {

const FlattenResult& sample() {
    static const FlattenResult result = [] {
        const SampleLast last = make_sample_last();
        FlattenOptions options = lastflat::test::sample_options(last);
        options.request.constraints.push_back(range("topline", -1.0, 1.0, "lateral"));
        options.request.constraints.push_back({TotalArea{-1.0, 1.0, "medial"}});
        options.request.points = {{"waist_end_lateral", Index{12}}};
        return lastflat::test::flatten_sample(last, options);
    }();
    return result;
}

nlohmann::json written() {
    return nlohmann::json::parse(to_json(sample(), "1.2.3"));
}

}  // namespace

TEST_SUITE("api/flatten_result") {
    TEST_CASE("a verdict stands where something was asked, ease where nothing was") {
        const auto result = written();
        std::size_t locked = 0;
        for (const auto& region : result["regions"]) {
            for (const auto& curve : region["curves"]) {
                CAPTURE(curve.dump());
                const bool is_locked = curve["locked"];
                locked += is_locked;
                CHECK(curve.contains("verdict") == is_locked);
                CHECK(curve.contains("ease_mm") == !is_locked);
                CHECK(curve.contains("ease_percent") == !is_locked);
                CHECK(curve.contains("zones") == (curve["name"] == "featherline"));
                if (is_locked) continue;
                const double ease =
                    curve["length_2d_mm"].get<double>() - curve["length_3d_mm"].get<double>();
                CHECK(curve["ease_mm"].get<double>() == doctest::Approx(ease));
                CHECK(curve["ease_percent"].get<double>() ==
                      doctest::Approx(100.0 * ease / curve["length_3d_mm"].get<double>()));
            }
            CHECK(region["metrics"].contains("area_verdict") == (region["name"] == "medial"));
        }
        CHECK(locked == 4);
        CHECK(result["regions"][1]["metrics"]["area_verdict"] == "pass");
    }

    TEST_CASE("the zones of the featherline and the points that end them are listed") {
        const auto result = written();
        const auto& curves = result["regions"][0]["curves"];
        const auto featherline = std::find_if(
            curves.begin(), curves.end(), [](const auto& c) { return c["name"] == "featherline"; });
        std::string names;
        double ease = 0.0;
        for (const auto& zone : (*featherline)["zones"]) {
            names += zone["name"].get<std::string>() + " ";
            ease += zone["ease_mm"].get<double>();
        }
        CHECK(names == "toe joint waist seat ");
        CHECK(ease == doctest::Approx((*featherline)["ease_mm"].get<double>()));
        REQUIRE(result["points"].size() == 6);
        CHECK(result["points"][0]["name"] == "toe_end_lateral");
        CHECK(result["points"][0]["region"] == "lateral");
        CHECK(result["points"][0]["given"] == false);
        CHECK(result["points"][2]["given"] == true);
        CHECK(result["points"][5]["name"] == "waist_end_medial");
    }

    TEST_CASE("strain has one sign: above 0 stretched, below 0 gathered") {
        const auto result = written();
        for (const auto& region : result["regions"]) {
            const auto& stretch = region["stretch"];
            CHECK(stretch["most_gathered_percent"].get<double>() < -10.0);
            CHECK(stretch["most_stretched_percent"].get<double>() > 5.0);
            CHECK(stretch["area_percent"]["p01"].get<double>() < 0.0);
            CHECK(stretch["area_percent"]["p99"].get<double>() > 0.0);
        }
    }
}

TEST_SUITE("api/result_table") {
    TEST_CASE("a right pattern is told without a fail, and the headings say the signs") {
        const std::string table = to_table(sample());
        CHECK(table.find("fail") == std::string::npos);
        CHECK(table.find("flat - last: above 0 a curve is gathered") == 0);
        CHECK(table.find("strain of the leather when it is lasted: above 0 stretched") !=
              std::string::npos);
        CHECK(table.find(
                  "\nlateral  heel           78.710   78.710        0.000000    0.000  pass\n") !=
              std::string::npos);
        CHECK(table.find("\nlateral    waist") != std::string::npos);
        CHECK(table.find("pair heel: lateral and medial differ by 0.000000 mm  pass\n") !=
              std::string::npos);
        CHECK(table.find("\nrange of topline in lateral: ") != std::string::npos);
        CHECK(table.find("  pass\ntotal area of medial: ") != std::string::npos);
    }

    TEST_CASE("what fails and what is warned of is told") {
        FlattenResult bad = sample();
        bad.regions[0].curves[0].verdict = Verdict::fail;
        bad.regions[0].stretch.material_verdict = Verdict::warn;
        bad.warnings.push_back({"landmark_unsure", "look at it", std::nullopt});
        const std::string table = to_table(bad);
        CHECK(table.find("  fail\n") != std::string::npos);
        CHECK(table.find("  warn\n") != std::string::npos);
        CHECK(table.find("\nwarning: look at it\n") != std::string::npos);
    }
}

}  // namespace lastflat::api
