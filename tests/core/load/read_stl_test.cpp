#include "core/load/read_stl.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>

#include "tests/helpers/errors.h"

namespace lastflat {
namespace {

using test::has;
using test::load_error;

template <class T>
void append(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// `triangles` times the same triangle; `announced` stands in the header.
std::string binary(std::uint32_t announced, int triangles, const std::string& header = "scan") {
    std::string bytes = header;
    bytes.resize(80, ' ');
    append(bytes, announced);
    for (int t = 0; t < triangles; ++t) {
        for (const int number : {0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3, 0})
            append(bytes, static_cast<float>(number));
        append(bytes, std::uint16_t{0});
    }
    return bytes;
}

const std::string text =
    "solid one\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 2 0 0\n   vertex 0 "
    "3 0\n  endloop\n endfacet\nendsolid one\n";

}  // namespace

TEST_SUITE("core/load/read_stl") {
    TEST_CASE("text and binary give the same triangle, not indexed") {
        for (const std::string& bytes : {text, binary(1, 1), binary(1, 1, "solid binary")}) {
            const RawMesh mesh = load_model(bytes);
            CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}});
            CHECK(mesh.positions == Points3{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}});
            CHECK_FALSE(mesh.indexed);
        }
    }

    TEST_CASE("solids are groups, and an empty one is no harm") {
        std::string second = text;
        second.replace(6, 3, "two");
        const RawMesh mesh = load_model("solid nothing\nendsolid nothing\n" + text + second);
        REQUIRE(mesh.triangles.size() == 2);
        CHECK(mesh.label_sets[mesh.triangle_labels[0]] == std::vector<std::string>{"one"});
        CHECK(mesh.label_sets[mesh.triangle_labels[1]] == std::vector<std::string>{"two"});
    }

    TEST_CASE("a count that lies is replaced by the bytes that are there") {
        CHECK(load_model(binary(0, 3)).triangles.size() == 3);
        CHECK(load_model(binary(4'000'000'000U, 3)).triangles.size() == 3);
        CHECK(has(load_error(binary(2, 2).substr(0, 84 + 70)), "unreadable_model"));
    }

    TEST_CASE("a file that was cut off inside a triangle is said to be") {
        const std::string cut = binary(9, 5).substr(0, 84 + 4 * 50 + 21);
        CHECK(has(load_error(cut), "STL: 9 triangles are announced"));
        CHECK(has(load_error(cut), "cut off"));
        std::string other = cut;  // what stands where a normal should is none
        other[84] = other[85] = other[86] = other[87] = 'x';
        CHECK_FALSE(has(load_error(other), "STL"));
    }

    TEST_CASE("what follows the triangles of the count is passed over with a warning") {
        CHECK(load_model(binary(2, 2)).warnings.empty());
        CHECK(load_model(binary(0, 2)).warnings.empty());
        for (const std::size_t more : {1, 2, 49, 50, 134}) {
            CAPTURE(more);
            const RawMesh mesh = load_model(binary(2, 2) + std::string(more, '\x41'));
            CHECK(mesh.triangles.size() == 2);
            REQUIRE(mesh.warnings.size() == 1);
            CHECK(mesh.warnings[0].code == "trailing_bytes");
            CHECK(
                has(mesh.warnings[0].detail, " " + std::to_string(more) + " bytes follow the 2 "));
            CHECK(has(mesh.warnings[0].detail, "room for") == (more >= 50));
        }
    }

    TEST_CASE("empty lines and comments may stand before and between solids") {
        for (const std::string before :
             {"\r\n", "\r\n\r\n", "# by hand\n# solid\n", " \t# x\r\n\r\n"}) {
            CAPTURE(before);
            const RawMesh mesh = load_model(before + text + before + text);
            CHECK(mesh.triangles.size() == 2);
            CHECK(mesh.label_sets.back() == std::vector<std::string>{"one"});
        }
    }

    TEST_CASE("lines may end with CR alone, and are counted") {
        std::string other = text;
        std::replace(other.begin(), other.end(), '\n', '\r');
        const RawMesh mesh = load_model("# by hand\r" + other);
        CHECK(mesh.triangles.size() == 1);
        CHECK(mesh.label_sets.back() == std::vector<std::string>{"one"});
        other.replace(other.find("3 0\r"), 1, "x");
        CHECK(has(load_error(other), "STL line 6: 'x' is not a number"));
        for (auto at = other.find('\r'); at < other.size(); at = other.find('\r', at + 2))
            other.insert(at + 1, 1, '\n');
        CHECK(has(load_error(other), "STL line 6: 'x' is not a number"));
    }

    TEST_CASE("a name that is no UTF-8 is Latin-1") {
        std::string other = text;
        other.replace(6, 3,
                      "au\xdf"
                      "en");
        CHECK(load_model(other).label_sets.back() == std::vector<std::string>{"au\xc3\x9f"
                                                                              "en"});
    }

    TEST_CASE("what is broken is named with its line or its triangle") {
        std::string broken = text;
        broken.replace(broken.find("3 0\n"), 1, "x");
        CHECK(has(load_error(broken), "STL line 6: 'x' is not a number"));
        CHECK(has(load_error("solid\nfacet normal 0 0 1\nouter loop\nendloop\n"),
                  "STL line 4: 'endloop' where 'vertex' is needed"));
        std::string infinite = binary(1, 1);
        const float number = INFINITY;
        std::memcpy(infinite.data() + 100, &number, sizeof number);
        CHECK(has(load_error(infinite), "mesh_degenerate: STL: a coordinate of triangle 0"));
        CHECK(has(load_error("solid a\nendsolid a\n"), "has no triangle"));
    }

    TEST_CASE("limits hold before memory is taken") {
        LoadLimits limits;
        limits.triangles = 2;
        CHECK_THROWS_AS((void)load_model(binary(3, 3), limits), Error);
        CHECK_THROWS_AS((void)load_model(text + text + text, limits), Error);
        limits = {};
        limits.vertices = 3;  // those of one triangle; welding joins them
        CHECK(load_model(binary(3, 3), limits).triangles.size() == 3);
    }
}

}  // namespace lastflat
