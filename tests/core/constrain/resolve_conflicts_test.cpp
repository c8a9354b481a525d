#include "core/constrain/resolve_conflicts.h"

#include <doctest/doctest.h>

#include "core/border/convex_border.h"
#include "core/parameterize/fixed_border.h"
#include "tests/helpers/shapes.h"

namespace lastflat {
namespace {

ConstrainedChart resolved(const Region& region, const std::vector<Constraint>& constraints,
                          OnConflict on_conflict = OnConflict::fail) {
    const Domain domain({&region});
    const Chart start = flatten_fixed_border(region, mean_value_weights, circle_border(region));
    const SymmetricDirichlet energy;
    return least_distortion(domain, {start}, {constraints, energy, {}, on_conflict}, 1, Progress());
}

}  // namespace

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
            (void)resolved(region, locks);
            FAIL("no error");
        } catch (const Error& error) {
            CHECK(error.code() == ErrorCode::constraints_infeasible);
            CHECK(std::string(error.what()).find("lock of ") != std::string::npos);
            CHECK(error.position().has_value());
        }
    }
}

}  // namespace lastflat
