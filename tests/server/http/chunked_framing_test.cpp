#include "server/http/chunked_framing.h"

#include <doctest/doctest.h>

#include <string>

using lastflat::http::Buffer;
using lastflat::http::ChunkedFraming;

namespace {

/// "complete n data" with the length of the body, "broken", "too large" or "more".
std::string verdict(const std::string& bytes, std::size_t step, std::uint64_t most_data = 100) {
    ChunkedFraming framing(most_data);
    Buffer data;
    std::size_t followed = 0;
    for (std::size_t at = 0; at < bytes.size(); at += step) {
        followed += framing.follow(std::string_view(bytes).substr(at, step), data);
    }
    if (framing.complete())
        return "complete " + std::to_string(followed) + " " + std::string(data.view());
    return framing.broken() ? "broken" : framing.too_large() ? "too large" : "more";
}

struct ChunkedRow {
    std::string bytes;
    std::string verdict;
};

}  // namespace

TEST_SUITE("server/http/chunked_framing") {
    TEST_CASE("a chunked body ends where RFC 9112 says, however it is cut") {
        const ChunkedRow rows[] = {
            {"0\r\n\r\n", "complete 5 "},
            {"5\r\nhello\r\n0\r\n\r\nGET /", "complete 15 hello"},
            {"5;name=\"v\"\r\nhello\r\n000\r\n\r\n", "complete 26 hello"},
            {"A\r\n0\r\n\r\n01234\r\n0\r\n\r\n", "complete 20 0\r\n\r\n01234"},
            {"5\r\nhello\r\n", "more"},
            {"5\r\nhello\r\n0\r\n", "more"},
            {"5\r\nhel", "more"},
            {"", "more"},
            {"-2\r\n", "broken"},
            {"+2\r\n", "broken"},
            {"0x5\r\n", "broken"},
            {" 5\r\n", "broken"},
            {"5 \r\n", "broken"},
            {"\r\n", "broken"},
            {";x\r\n", "broken"},
            {"5\nhello", "broken"},
            {"5\r\r", "broken"},
            {"5\r\nhelloX", "broken"},
            {"5\r\nhello\n", "broken"},
            {"5\r\nhello0\r\n\r\n", "broken"},
            {"0\r\nTrailer: x\r\n\r\n", "broken"},
            {"5;a\nb\r\n", "broken"},
            {"5;" + std::string(300, 'x'), "broken"},
            {std::string(300, '0'), "broken"},
            {"65\r\n", "too large"},
            {"64\r\n", "more"},
            {"32\r\n" + std::string(50, 'x') + "\r\n33\r\n", "too large"},
            {"ffffffffffffffffffffffff\r\n", "too large"},
        };
        for (const ChunkedRow& row : rows) {
            for (const std::size_t step : {1, 2, 3, 1000}) {
                CAPTURE(row.bytes);
                CAPTURE(step);
                CHECK(verdict(row.bytes, step) == row.verdict);
            }
        }
    }
}
