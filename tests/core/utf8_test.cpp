#include "core/utf8.h"

#include <doctest/doctest.h>

namespace lastflat {

TEST_SUITE("core/utf8") {
    TEST_CASE("UTF-8 has no overlong forms, surrogates or points beyond the last") {
        for (const char* good : {"", "a", "\xc2\x80", "\xed\x9f\xbf", "\xee\x80\x80",
                                 "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf"}) {
            CAPTURE(good);
            CHECK(is_utf8(good));
        }
        for (const char* bad : {"\x80", "\xc0\xaf", "\xc1\xbf", "\xe0\x80\x80", "\xe0\x9f\xbf",
                                "\xed\xa0\x80", "\xf0\x8f\xbf\xbf", "\xf4\x90\x80\x80",
                                "\xf5\x80\x80\x80", "\xff", "\xc3", "\xe2\x82", "a\xc3g"}) {
            CAPTURE(bad);
            CHECK_FALSE(is_utf8(bad));
        }
    }

    TEST_CASE("what is no UTF-8 is Latin-1, and UTF-8 stays as it is") {
        CHECK(as_utf8("au\xdf"
                      "en") ==
              "au\xc3\x9f"
              "en");
        CHECK(as_utf8("au\xc3\x9f"
                      "en") ==
              "au\xc3\x9f"
              "en");
        CHECK(as_utf8("\x80\xff") == "\xc2\x80\xc3\xbf");
        CHECK(as_utf8("").empty());
    }
}

}  // namespace lastflat
