#include "server/http/client_address.h"

#include <doctest/doctest.h>

namespace lastflat::http {

TEST_SUITE("server/http/client_address") {
    TEST_CASE("only a trusted proxy can name another address") {
        const std::vector<std::string> proxies{"127.0.0.1", "10.0.0.2"};
        CHECK(client_address("203.0.113.9", "198.51.100.7", proxies) == "203.0.113.9");
        CHECK(client_address("127.0.0.1", "198.51.100.7", {}) == "127.0.0.1");
        CHECK(client_address("::ffff:127.0.0.1", "198.51.100.7", proxies) == "198.51.100.7");
        CHECK(client_address("127.0.0.1", "", proxies) == "127.0.0.1");
        CHECK(client_address("127.0.0.1", "198.51.100.7", proxies) == "198.51.100.7");
        CHECK(client_address("127.0.0.1", "1.2.3.4, 198.51.100.7 ,10.0.0.2", proxies) ==
              "198.51.100.7");
        CHECK(client_address("127.0.0.1", "2001:db8::1", proxies) == "2001:db8::1");
        CHECK(client_address("127.0.0.1", "198.51.100.7, no address", proxies) == "127.0.0.1");
        CHECK(client_address("127.0.0.1", "10.0.0.2, 127.0.0.1", proxies) == "10.0.0.2");
    }

    TEST_CASE("an IPv6 client is its network") {
        CHECK(network_of("198.51.100.7") == "198.51.100.7");
        CHECK(network_of("2001:db8:1:2:3:4:5:6") == network_of("2001:db8:1:2:ffff::1"));
        CHECK(network_of("2001:db8:1:2::1") != network_of("2001:db8:1:3::1"));
        CHECK(network_of("::ffff:10.0.0.1") != network_of("::ffff:10.0.0.2"));
    }
}

}  // namespace lastflat::http
