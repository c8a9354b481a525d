#include "core/weld/unit_of.h"

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include "tests/helpers/bare_sample.h"
#include "tests/helpers/errors.h"

namespace lastflat {
namespace {

/// The sample last, so many units long.
RawMesh sample_of(double units) {
    static const RawMesh sample = test::bare_sample();
    Eigen::AlignedBox3d box;
    for (const Vec3& p : sample.positions) box.extend(p);
    RawMesh scaled = sample;
    for (Vec3& p : scaled.positions) p *= units / box.sizes().maxCoeff();
    return scaled;
}

std::string warned(const UnitGuess& guess) {
    return guess.warning ? guess.warning->code : "";
}

}  // namespace

TEST_SUITE("core/weld/unit_of") {
    TEST_CASE("a unit that makes no last's length is told, an infant's last is one") {
        WeldOptions options;
        for (const auto& [units, unit_mm, code] : {std::tuple(94.0, 1.0, "size_unusual"),
                                                   {96.0, 1.0, ""},
                                                   {107.0, 1.0, ""},
                                                   {349.0, 1.0, ""},
                                                   {351.0, 1.0, "size_unusual"},
                                                   {26.5, 10.0, ""},
                                                   {191.0, 1000.0, "size_unusual"}}) {
            CAPTURE(units);
            options.unit_mm = unit_mm;
            const UnitGuess guess = unit_of(sample_of(units), options);
            CHECK(guess.unit_mm == unit_mm);
            CHECK(warned(guess) == code);
        }
        options.unit_mm = 1000.0;
        CHECK(test::has(unit_of(sample_of(191.0), options).warning->detail, "191000 mm long"));
    }

    TEST_CASE("the last's length says the unit where nobody does") {
        WeldOptions options;
        options.last_length_mm = 265.0;
        for (const auto& [units, unit_mm, code] : {std::tuple(265.0, 1.0, ""),
                                                   {26.5, 10.0, ""},
                                                   {26.6, 10.0, ""},
                                                   {0.265, 1000.0, ""},
                                                   {265.0 / 25.4, 25.4, ""},
                                                   {300.0, 265.0 / 300.0, "unit_assumed"},
                                                   {27.0, 265.0 / 27.0, "unit_assumed"}}) {
            CAPTURE(units);
            const UnitGuess guess = unit_of(sample_of(units), options);
            CHECK(guess.unit_mm == doctest::Approx(unit_mm).epsilon(1e-12));
            CHECK(warned(guess) == code);
        }
    }

    TEST_CASE("and is checked where one is given") {
        WeldOptions options;
        options.unit_mm = 10.0;
        options.last_length_mm = 265.0;
        CHECK(warned(unit_of(sample_of(27.5), options)).empty());
        for (const double units : {25.0, 28.0}) {
            const std::string error =
                test::error_of([&] { (void)unit_of(sample_of(units), options); });
            CHECK(test::has(error, "not 265"));
            CHECK(test::has(error, "last_length_mm"));
        }
    }
}

}  // namespace lastflat
