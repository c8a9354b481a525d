#include "server/protocol/session_messages.h"

#include <doctest/doctest.h>

#include <sstream>

namespace lastflat::server {

TEST_SUITE("server/session_messages") {
    TEST_CASE("an ask comes back as it was, whatever bytes its text has") {
        const SessionAsk ask{7, AskKind::change, 41, true, "{\"tag\": \"a\n\xff\"}"};
        std::istringstream sent(to_bytes(ask) + to_bytes(SessionAsk{8}));
        const SessionAsk read = read_session_ask(sent).value();
        CHECK(read.number == 7);
        CHECK(read.kind == AskKind::change);
        CHECK(read.sequence == 41);
        CHECK(read.points);
        CHECK(read.text == ask.text);
        CHECK(read_session_ask(sent).value().number == 8);
        CHECK_FALSE(read_session_ask(sent).has_value());
    }

    TEST_CASE("answers are taken one after the other, each once it is whole") {
        const std::string body("a\nb\0c", 5);
        std::string sent = to_bytes({1, {}, body});
        sent += to_bytes({2, api::Problem("superseded", "a newer one"), {}});
        std::string read;
        std::uint64_t answers = 0;
        for (const char byte : sent) {
            read += byte;
            while (const auto answer = take_session_answer(read)) {
                CHECK(answer->number == ++answers);
                CHECK(answer->problem.has_value() == (answers == 2));
                if (answers == 1) CHECK(answer->body == body);
            }
        }
        CHECK(answers == 2);
        CHECK(read.empty());
    }

    TEST_CASE("what is no answer is told apart from one that is not whole") {
        for (const char* nonsense : {"hello\n", "{}\n", "{\"number\":1}\n",
                                     "{\"number\":1,\"bytes\":9999999999}\n", "[1]\n"}) {
            CAPTURE(nonsense);
            std::string read = nonsense;
            CHECK_THROWS((void)take_session_answer(read));
        }
        std::string endless(2u << 20, 'x');
        CHECK_THROWS((void)take_session_answer(endless));
        std::string begun = "{\"number\":1,";
        CHECK_FALSE(take_session_answer(begun).has_value());
    }
}

}  // namespace lastflat::server
