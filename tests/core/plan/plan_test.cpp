#include "core/plan/plan.h"

#include <doctest/doctest.h>

#include "api/flatten_request.h"
#include "api/request_json.h"
#include "core/flatten.h"
#include "core/load/load_model.h"
#include "core/weld/weld.h"
#include "tests/helpers/sample.h"
#include "tests/helpers/sheets.h"

namespace lastflat {
namespace {

/// The sample last without its groups: nothing is said of it.
std::string bare_sample() {
    SampleLast last = make_sample_last();
    last.mesh.label_sets = {{}};
    last.mesh.triangle_labels.assign(last.mesh.triangles.size(), 0);
    return write_model_obj(last.mesh);
}

CurveSource own_heel() {
    return {curve_name::heel, VertexPath{make_sample_last().curves[1].second}};
}

std::vector<std::string> names_of(const std::vector<CurveSource>& curves) {
    std::vector<std::string> names;
    for (const CurveSource& curve : curves) names.push_back(curve.name);
    return names;
}

FlattenResult run(const std::string& model, const Request& request) {
    Progress progress;
    FlattenOptions options;
    options.request = request;
    return flatten(model, options, progress);
}

}  // namespace

TEST_SUITE("core/plan") {
    TEST_CASE("of a bare last everything is found, and the centre line locked") {
        const SurfaceMesh surface = weld(load_model(bare_sample()));
        const Plan plan = make_plan(surface, {});
        CHECK(plan.found == Plan::Found::all);
        REQUIRE(plan.landmarks.has_value());
        CHECK(plan.landmarks->curves.empty());  // they stand once, in the request
        CHECK(names_of(plan.request.curves) ==
              std::vector<std::string>{"featherline", "topline", "centre_front", "heel"});
        CHECK(plan.request.cut.cuts.size() == 4);
        REQUIRE(plan.request.cut.regions.size() == 2);
        CHECK(plan.request.cut.regions[0].name == "lateral");
        REQUIRE(plan.request.constraints.size() == 2);
        CHECK(std::get<Lock>(plan.request.constraints[0].demand).curve == "centre_front");
        CHECK(std::get<Lock>(plan.request.constraints[1].demand).curve == "heel");
    }

    TEST_CASE("what a request says of a bare last stands") {
        const SurfaceMesh surface = weld(load_model(bare_sample()));
        Request request;
        request.curves = {own_heel()};
        request.constraints = {{Lock{"topline"}}};
        request.cut.holes = HoleRule::keep;
        const Plan plan = make_plan(surface, request);
        CHECK(plan.found == Plan::Found::some);
        CHECK(names_of(plan.request.curves) ==
              std::vector<std::string>{"featherline", "heel", "topline", "centre_front"});
        CHECK(std::holds_alternative<VertexPath>(plan.request.curves[1].form));
        REQUIRE(plan.request.constraints.size() == 1);
        CHECK(std::get<Lock>(plan.request.constraints[0].demand).curve == "topline");
        CHECK(plan.request.cut.holes == HoleRule::keep);
    }

    TEST_CASE("nothing is looked for where the request says what to cut, or the surface is open") {
        const SampleLast last = make_sample_last();
        const Request asked = test::sample_options(last).request;
        for (const Request& request : {asked, Request{}}) {
            const std::string model =
                request.curves.empty() ? test::sheet_obj(4, 4, test::flat) : bare_sample();
            const Plan plan = make_plan(weld(load_model(model)), request);
            CHECK(plan.found == Plan::Found::none);
            CHECK_FALSE(plan.landmarks.has_value());
            CHECK(plan.request.curves.size() == request.curves.size());
            CHECK(plan.request.constraints.size() == request.constraints.size());
        }
    }

    TEST_CASE("curves are put in the order in which they can end on each other") {
        Request request;
        const Points3 open{{0, 0, 0}, {1, 0, 0}};
        const Points3 closed{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
        request.curves = {
            {"a", Polyline{open}}, {"b", Polyline{closed}}, {"c", ShortestPath{{"p", "q"}}},
            {"e", NamedLine{"l"}}, {"f", BorderAt{0}},      {"d", VertexPath{{0, 1}}}};
        const Plan plan = make_plan(weld(load_model(test::sheet_obj(4, 4, test::flat))), request);
        CHECK(names_of(plan.request.curves) ==
              std::vector<std::string>{"b", "d", "f", "c", "a", "e"});
    }

    TEST_CASE("pins and zones are named by the vertices that stand for theirs") {
        // Two triangles that share no vertices.
        WeldOptions options;
        options.tolerance_mm = 0.0;
        const SurfaceMesh surface = weld(
            load_model("v 0 0 0\nv 9 0 0\nv 0 9 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\nf 1 2 3\nf 4 5 6\n"),
            options);
        Request request;
        request.constraints = {{Pin{3, Vec2::Zero()}}};
        request.weights.zones = {{{}, 5, {3, 4, 5}, 1.0, 2.0}};
        const Request planned = make_plan(surface, request).request;
        CHECK(std::get<Pin>(planned.constraints[0].demand).vertex == 1);
        CHECK(planned.weights.zones[0].vertex == 2);
        CHECK(planned.weights.zones[0].vertices == std::vector<Index>{1, 4, 2});
    }

    TEST_CASE("run again as a request, in words or not, it gives the same pattern to the byte") {
        const std::string model = bare_sample();
        Request with_heel;
        with_heel.curves = {own_heel()};
        with_heel.weld.unit_mm = 1.0;
        with_heel.constraints = {
            {Lock{"heel", Keep::total}}, {TotalArea{}}, {Lock{"centre_front"}}};
        for (const Request& request : {Request{}, with_heel}) {
            const FlattenResult first = run(model, request);
            const std::string words = api::request_json(first.plan.request).dump();
            for (const Request& again :
                 {first.plan.request, api::flatten_request_from_json(words).asked}) {
                const FlattenResult second = run(model, again);
                REQUIRE(second.regions.size() == first.regions.size());
                for (std::size_t r = 0; r < first.regions.size(); ++r) {
                    CHECK(second.regions[r].region.name == first.regions[r].region.name);
                    CHECK(second.regions[r].chart.uv == first.regions[r].chart.uv);
                    CHECK(second.regions[r].region.source_vertices ==
                          first.regions[r].region.source_vertices);
                }
                CHECK(api::request_json(second.plan.request).dump() == words);
            }
        }
    }
}

}  // namespace lastflat
