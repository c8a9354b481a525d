#include "core/cut/left_out.h"

#include <doctest/doctest.h>

#include "tests/helpers/sample.h"
#include "tests/helpers/sheets.h"

namespace lastflat {
namespace {

std::vector<std::string> codes(const FlattenResult& result) {
    std::vector<std::string> found;
    for (const Warning& warning : result.warnings) found.push_back(warning.code);
    return found;
}

}  // namespace

TEST_SUITE("core/cut/left_out") {
    TEST_CASE("a half that no region names is told with its place; both are not") {
        const SampleLast last = make_sample_last();
        FlattenOptions options = test::sample_options(last);
        CHECK(codes(test::flatten_sample(last, options)).empty());
        options.request.cut.regions.pop_back();
        const FlattenResult result = test::flatten_sample(last, options);
        REQUIRE(codes(result) == std::vector<std::string>{"piece_left_out"});
        // Where it is told it may be named.
        options.request.cut.regions.push_back({"medial", Location{*result.warnings[0].position}});
        const FlattenResult both = test::flatten_sample(last, options);
        CHECK(codes(both).empty());
        CHECK(both.regions.at(1).metrics.area_3d_mm2 > 20'000);
    }

    TEST_CASE("sole and top of a whole last are no pieces of its upper") {
        const SampleLast last = make_sample_last();
        FlattenOptions options = test::sample_options(last);
        options.request.weld.groups.clear();
        options.request.cut.cuts = {"featherline", "topline", "centre_front", "heel"};
        CHECK(codes(test::flatten_sample(last, options)).empty());
        options.request.cut.regions.pop_back();
        CHECK(codes(test::flatten_sample(last, options)) ==
              std::vector<std::string>{"piece_left_out"});
    }

    TEST_CASE("nothing is told where the request names no regions, or a last was found") {
        const SampleLast last = make_sample_last();
        FlattenOptions options = test::sample_options(last);
        options.request.cut.regions.clear();
        CHECK(codes(test::flatten_sample(last, options)).empty());
        CHECK(codes(test::flatten_sample(last, {})).empty());
    }

    TEST_CASE("a loose piece is told, and of many the ten largest") {
        std::string obj;
        for (int i = 0; i < 13; ++i) {
            const std::string x = std::to_string(100 * i), size = std::to_string(40 + i);
            obj += "v " + x + " 0 0\nv " + x + " " + size + " 0\nv " + x + " 0 " + size +
                   "\nf -3 -2 -1\n";
        }
        FlattenOptions options;
        options.request.weld.unit_mm = 1.0;
        options.request.cut.regions = {{"only", Location{Index{0}}}};
        Progress progress;
        const FlattenResult result = flatten(obj, options, progress);
        std::size_t told = 0;
        for (const Warning& warning : result.warnings) told += warning.code == "piece_left_out";
        CHECK(told == 10);
    }
}

}  // namespace lastflat
