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
        CHECK(has(load_error(header("latin") + points), "the format 'latin' is not known"));
        CHECK(has(load_error("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                             "end_header\n0\n"),
                  "no property 'y'"));
    }
}

}  // namespace lastflat
