#include "core/constrain/resolve_conflicts.h"

#include <doctest/doctest.h>

#include "core/measure/report.h"
#include "tests/helpers/constraints.h"
#include "tests/helpers/minimum.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
TEST_SUITE("core/constrain/resolve_conflicts") {
    TEST_CASE("lengths that cannot be kept are an error that names a curve") {
        // On a dome the whole border and a ring inside it cannot all keep their edges.
        Region region = test::dome(6, 1.3);
        std::vector<Constraint> locks{lock("bottom"), lock("right"), lock("top"), lock("left")};
        for (int j = 1; j < 6; ++j) {
            const std::string name = "row " + std::to_string(j);
            region.runs.push_back({name, {}});
            for (int i = 0; i <= 6; ++i) region.runs.back().vertices.push_back(j * 7 + i);
            locks.push_back(lock(name));
            region.runs.push_back({"column " + std::to_string(j), {}});
            for (int i = 0; i <= 6; ++i) region.runs.back().vertices.push_back(i * 7 + j);
            locks.push_back(lock("column " + std::to_string(j)));
        }
        // All grid lines locked leaves the cells rhombs free to shear: still feasible or not, the
        // diagonals of one row make it rigid.
        region.runs.push_back({"diagonal", {}});
        for (int i = 0; i <= 6; ++i) region.runs.back().vertices.push_back(i * 8);
        locks.push_back(lock("diagonal"));
        try {
            (void)test::flattened({&region}, locks);
            FAIL("no error");
        } catch (const Error& error) {
            CHECK(error.code() == ErrorCode::constraints_infeasible);
            CHECK(std::string(error.what()).find("lock of ") != std::string::npos);
            CHECK(error.position().has_value());
        }
    }

    TEST_CASE("the smallest fighting set leaves out what does not fight") {
        const Region region = test::saddle();
        std::vector<Constraint> constraints{lock("left"), lock("bottom"), range("bottom", 1, 2),
                                            lock("top", Keep::total)};
        for (std::size_t i = 0; i < constraints.size(); ++i)
            constraints[i].option = {"constraints", std::to_string(i)};
        try {
            (void)test::flattened({&region}, constraints);
            FAIL("no error");
        } catch (const Error& error) {
            CHECK(error.code() == ErrorCode::constraints_infeasible);
            REQUIRE(error.conflict().size() == 2);
            CHECK(error.conflict()[0].option[1] == "1");
            CHECK(error.conflict()[1].option[1] == "2");
            CHECK(error.conflict()[1].off_mm < 0.0);
        }
    }

    TEST_CASE("the least important gives way, the others hold") {
        const Region region = test::saddle();
        std::vector<Constraint> constraints{lock("left"), lock("bottom"), range("bottom", 1, 2)};
        for (const std::size_t weaker : {1u, 2u}) {
            constraints[1].priority = constraints[2].priority = 0;
            constraints[weaker].priority = -1;
            const auto result = test::flattened({&region}, constraints, OnConflict::relax);
            CHECK(result.relaxed == std::vector<std::size_t>{weaker});
            const auto reports = measure_constraints({region}, result.minimum.charts, constraints);
            REQUIRE(reports.size() == 3);
            for (std::size_t c = 0; c < 3; ++c) CHECK(reports[c].kept == (c != weaker));
        }
    }

    TEST_CASE("what a relaxed lock held is still held by another that names it") {
        Region region = test::saddle();
        region.runs.push_back({"part", {3, 4, 5, 6}});  // of the bottom
        std::vector<Constraint> constraints{lock("bottom"), lock("part"), range("bottom", 1, 2)};
        constraints[0].priority = -1;
        const auto result = test::flattened({&region}, constraints, OnConflict::relax);
        CHECK(result.relaxed == std::vector<std::size_t>{0});
        const auto reports = measure_constraints({region}, result.minimum.charts, constraints);
        CHECK(reports[1].kept);
        CHECK(reports[2].kept);
    }

    TEST_CASE("constraints that can all hold are no conflict, however far the start is") {
        const Region region = test::dome(8, 1.2);
        std::vector<Constraint> constraints{lock("left"), lock("right"), lock("top"),
                                            lock("bottom")};
        const auto result = test::flattened({&region}, constraints);
        for (const auto& report : measure_constraints({region}, result.minimum.charts, constraints))
            CHECK(report.kept);
    }
}

}  // namespace lastflat
