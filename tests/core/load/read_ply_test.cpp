#include "core/load/read_ply.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "tests/helpers/errors.h"

namespace lastflat {
namespace {

using test::has;
using test::load_error;

std::string header(const std::string& format, const std::string& faces = "1") {
    return "ply\nformat " + format +
           " 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty double "
           "y\nproperty float z\nproperty uchar red\nelement face " +
           faces + "\nproperty list uchar int vertex_indices\nend_header\n";
}

template <class T>
void append(std::string& bytes, T value, bool big) {
    std::string raw(reinterpret_cast<const char*>(&value), sizeof value);
    if (big) std::reverse(raw.begin(), raw.end());
    bytes += raw;
}

std::string binary(bool big) {
    std::string bytes = header(big ? "binary_big_endian" : "binary_little_endian");
    const double corners[4][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
    for (const auto& corner : corners) {
        append(bytes, static_cast<float>(corner[0]), big);
        append(bytes, corner[1], big);
        append(bytes, 0.0F, big);
        bytes.push_back('\x7F');
    }
    bytes.push_back(4);
    for (const std::int32_t v : {0, 1, 2, 3}) append(bytes, v, big);
    return bytes;
}

}  // namespace

TEST_SUITE("core/load/read_ply") {
    TEST_CASE("text and both byte orders give the same square, its polygon split") {
        const std::string text =
            header("ascii") + "0 0 0 1\n2 0 0 1\n2 2 0 1\n0 2 0 1\n4 0 1 2 3\n";
        for (const std::string& bytes : {text, binary(false), binary(true)}) {
            const RawMesh mesh = load_model(bytes);
            CHECK(mesh.positions == Points3{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
            CHECK(mesh.triangles.size() == 2);
            CHECK(mesh.indexed);
        }
    }

    TEST_CASE("strips alternate their winding, end at -1 and may turn corners") {
        const std::string points = "0 0 0 1\n2 0 0 1\n2 2 0 1\n0 2 0 1\n";
        const auto strips = [&](const std::string& values) {
            std::string ply = header("ascii");
            ply.replace(ply.find("face"), 4, "tristrips");
            return ply + points + values;
        };
        CHECK(load_model(strips("4 0 1 3 2\n")).triangles ==
              std::vector<Triangle>{{0, 1, 3}, {3, 1, 2}});
        CHECK(load_model(strips("8 0 1 2 -1 0 2 3 -1\n")).triangles ==
              std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
        CHECK(load_model(strips("6 0 1 3 3 2 1\n")).triangles ==
              std::vector<Triangle>{{0, 1, 3}, {2, 3, 1}});
        CHECK(has(load_error(strips("3 0 1 4\n")), "line 16: a face names vertex 4 of 4"));
        CHECK(has(load_error(strips("3 0 1 -2\n")), "line 16: a face names a vertex that"));
        CHECK(has(load_error(strips("3 0 1 -1\n")), "no face"));
        LoadLimits limits;
        limits.triangles = 1;
        CHECK(has(load_error(strips("4 0 1 3 2\n"), limits), "model_too_large"));
        CHECK(has(load_error(strips("6 -1 -1 -1 -1 -1 -1\n"), limits), "model_too_large"));
    }

    TEST_CASE("values left over on a line are refused with the line") {
        const std::string points = "0 0 0 1\n2 0 0 1\n2 2 0 1\n0 2 0 1\n";
        CHECK(has(load_error(header("ascii", "2") + points + "3 0 1 2\n3 0 2 3 0.5 0\n"),
                  "PLY line 17: '0.5 0' is left over"));
        CHECK(has(load_error(header("ascii") + "0 0 0 1 9\n2 0 0 1\n"),
                  "PLY line 12: '9' is left over"));
        CHECK(load_model(header("ascii") + points + "4 0 1 2 3 \t\r\n").triangles.size() == 2);
    }

    TEST_CASE("lines may end with CR alone, and are counted") {
        std::string text = header("ascii") + "0 0 0 1\n2 0 0 1\n2 2 0 1\n0 2 0 1\n4 0 1 2 3\n";
        std::replace(text.begin(), text.end(), '\n', '\r');
        CHECK(load_model(text).triangles.size() == 2);
        text.replace(text.size() - 2, 1, "7");
        CHECK(has(load_error(text), "PLY line 16: a face names vertex 7 of 4"));
    }

    TEST_CASE("behind a header with CR alone, LF is data") {
        const std::string begin = header("binary_little_endian");
        std::string bytes = binary(false);
        std::replace(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(begin.size()), '\n',
                     '\r');
        bytes[begin.size()] = '\n';  // the lowest byte of a coordinate
        const RawMesh mesh = load_model(bytes);
        CHECK(mesh.triangles.size() == 2);
        CHECK(mesh.positions[0].x() > 0.0);
        CHECK(mesh.positions[2] == Vec3(2, 2, 0));
    }

    TEST_CASE("what follows the last element is passed over with a warning") {
        const std::string text =
            header("ascii") + "0 0 0 1\n2 0 0 1\n2 2 0 1\n0 2 0 1\n4 0 1 2 3\n";
        CHECK(load_model(text + "\r\n \n").warnings.empty());
        CHECK(load_model(binary(true)).warnings.empty());
        for (const std::string& bytes : {text + "3 0 1 2\n", binary(false) + "x"}) {
            const RawMesh mesh = load_model(bytes);
            CHECK(mesh.triangles.size() == 2);
            REQUIRE(mesh.warnings.size() == 1);
            CHECK(mesh.warnings[0].code == "trailing_bytes");
        }
    }

    TEST_CASE("what lies about its size is refused before memory is taken") {
        CHECK(has(load_error(header("ascii", "99999999999") + "0 0 0 1\n"), "unreadable_model"));
        CHECK(has(load_error(header("binary_little_endian", "4000000000") +
                             binary(false).substr(header("binary_little_endian").size())),
                  "announces 4000000000 items"));
        CHECK(
            has(load_error(binary(false).substr(0, binary(false).size() - 3)), "unreadable_model"));
    }

    TEST_CASE("what is broken is named") {
        const std::string points = "0 0 0 1\n2 0 0 1\n2 2 0 1\n0 2 0 1\n";
        CHECK(
            has(load_error(header("ascii") + points + "3 0 1 9\n"), "a face names vertex 9 of 4"));
        CHECK(has(load_error(header("ascii") + points + "3 0 1 -1\n"), "does not exist"));
        CHECK(has(load_error(header("ascii") + points + "2 0 1\n"), "fewer than three corners"));
        CHECK(has(load_error(header("ascii", "2") + points + "3 0 1 2\n2 0 1\n"),
                  "PLY line 17: a face"));
        CHECK(has(load_error(header("latin") + points), "the format 'latin' is not known"));
        CHECK(has(load_error("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                             "end_header\n0\n"),
                  "no property 'y'"));
    }
}

}  // namespace lastflat
