#include "core/progress.h"

#include <doctest/doctest.h>

#include <vector>

namespace lastflat {

TEST_SUITE("core/progress") {
    TEST_CASE("while a stage goes on the fraction nears the next one's and never gets there") {
        std::vector<double> told;
        Progress progress([&](Stage stage, double fraction) {
            CHECK(stage == Stage::constrain);
            told.push_back(fraction);
        });
        progress.reach(Stage::constrain, 0.5, 0.9);
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
        while (told.size() < 4 && std::chrono::steady_clock::now() < end) progress.check();
        REQUIRE(told.size() == 4);
        CHECK(told.front() == 0.5);
        for (std::size_t i = 1; i < told.size(); ++i) {
            CHECK(told[i] > told[i - 1]);
            CHECK(told[i] < 0.9);
        }
        CHECK(progress.fraction() == told.back());
    }

    TEST_CASE("a canceled job reaches no stage") {
        Progress progress;
        progress.cancel();
        CHECK_THROWS_AS(progress.reach(Stage::cut, 0.2, 0.3), Error);
        CHECK(progress.stage() == Stage::load);
    }
}

}  // namespace lastflat
