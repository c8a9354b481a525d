// Live sessions of the real program, and of programs that are none.
#include "server/runner/live_sessions.h"

#include <doctest/doctest.h>

#include <atomic>
#include <cstdlib>
#include <fstream>

#include "api/refusal.h"
#include "server/runner/resident_maps.h"
#include "tests/helpers/eventually.h"
#include "tests/helpers/temporary_folder.h"

namespace lastflat::server {
namespace {

constexpr char ten_mm_square[] = "v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nf 1 2 3 4\n";

struct LiveSetting {
    lastflat::test::TemporaryFolder folder;
    SessionLimits limits{3, 2};

    LiveSetting() {
        if (const char* program = std::getenv("LASTFLAT"))
            limits.process.program =
                std::filesystem::path(program).replace_filename("lastflat-work");
    }
    /// A program that is no worker.
    void run_script(const std::string& body) {
        const auto path = folder.path() / "script";
        std::ofstream(path) << "#!/bin/sh\n" << body << "\n";
        std::filesystem::permissions(path, std::filesystem::perms::owner_all);
        limits.process.program = path;
    }
    [[nodiscard]] std::filesystem::path work() const {
        std::filesystem::create_directory(folder.path() / "work");
        return folder.path() / "work";
    }
};

template <class Call>
std::string code_refused(const Call& call) {
    try {
        (void)call();
    } catch (const api::Refusal& refusal) {
        return std::string(refusal.problem().code.word());
    }
    return "taken";
}

SessionAsk change(std::uint64_t sequence, std::string patch) {
    return {0, AskKind::change, sequence, false, std::move(patch)};
}

}  // namespace

TEST_SUITE("server/live_sessions") {
    TEST_CASE("a session answers changes from many threads: the newest wins, none is lost") {
        const LiveSetting s;
        LiveSessions sessions(s.limits, s.work());
        const auto opened = sessions.open("one", Task::session, ten_mm_square, "");
        CHECK(opened.second.find("\"revision\":1") != std::string::npos);
        std::atomic<int> taken{0}, superseded{0};
        std::vector<std::thread> threads;
        for (std::uint64_t t = 0; t < 4; ++t) {
            threads.emplace_back([&, t] {
                for (std::uint64_t i = 1; i <= 20; ++i) {
                    const std::string tag = std::to_string(4 * i + t);
                    const std::string end = code_refused([&] {
                        return sessions.find("one", opened.first.id)
                            .live->ask(change(4 * i + t, "{\"tag\": \"" + tag + "\"}"));
                    });
                    (end == "taken" ? taken : superseded) += 1;
                    CHECK((end == "taken" || end == "superseded"));
                }
            });
        }
        for (std::thread& thread : threads) thread.join();
        CHECK(taken + superseded == 80);
        CHECK(taken > 0);
        const auto live = sessions.find("one", opened.first.id).live;
        CHECK(live->ask({0, AskKind::request}) == R"({"tag":"83"})");
        CHECK(live->ask({0, AskKind::surface}).substr(0, 4) == "glTF");
        CHECK(live->waiting() == 0);
    }

    TEST_CASE("there are as many as may be, and others see none of them") {
        const LiveSetting s;
        LiveSessions sessions(s.limits, s.work());
        const auto open = [&](const char* owner) {
            return sessions.open(owner, Task::session, ten_mm_square, "").first.id;
        };
        const std::string first = open("one");
        (void)open("one");
        CHECK(code_refused([&] { return open("one"); }) == "key_sessions_full");
        const std::string third = open("two");
        CHECK(code_refused([&] { return open("three"); }) == "sessions_full");
        CHECK(code_refused([&] { return sessions.find("two", first).id; }) == "session_not_found");
        CHECK(sessions.list("one").size() == 2);
        sessions.close("one", first);
        CHECK(code_refused([&] { return sessions.find("one", first).id; }) == "session_not_found");
        (void)open("three");
        sessions.stop();
        CHECK(sessions.list("two").empty());
        CHECK(code_refused([&] { return open("two"); }) == "draining");
        CHECK(std::filesystem::is_empty(s.work()));
    }

    TEST_CASE("what cannot be flattened opens no session") {
        const LiveSetting s;
        LiveSessions sessions(s.limits, s.work());
        CHECK(code_refused([&] {
                  return sessions.open("one", Task::session, ten_mm_square, R"({"cuts": ["none"]})")
                      .second;
              }) == "curve_invalid");
        CHECK(sessions.list("one").empty());
        CHECK(std::filesystem::is_empty(s.work()));
    }

    TEST_CASE("one that nobody asks ends") {
        LiveSetting s;
        s.limits.idle = std::chrono::milliseconds(100);
        LiveSessions sessions(s.limits, s.work());
        (void)sessions.open("one", Task::session, ten_mm_square, "");
        CHECK(lastflat::test::eventually([&] { return sessions.list("one").empty(); }));
    }

    TEST_CASE("a program that dies, talks nonsense or says nothing loses the session alone") {
        LiveSetting s;
        s.limits.process.time = std::chrono::milliseconds(500);
        for (const char* body : {"exit 3", "echo hello", "kill -SEGV $$", "exec sleep 60",
                                 "printf '{\"number\":0,\"bytes\":2}\\n{}'; exec sleep 60"}) {
            CAPTURE(body);
            s.run_script(body);
            LiveSessions sessions(s.limits, s.work());
            CHECK(code_refused([&] {
                      const auto opened = sessions.open("one", Task::session, ten_mm_square, "");
                      return opened.first.live->ask(change(1, "{}"));
                  }) == "session_lost");
        }
    }

    TEST_CASE("a pattern stays in memory, and makes room for others") {
        const LiveSetting s;
        ResidentMaps maps(s.limits.process, s.work());
        const std::string obj =
            "g lateral\nv 0 0 0\nv 10 0 0\nv 0 10 0\nvt 0 0\nvt 10 0\nvt 0 10\nf 1/1 2/2 3/3\n";
        const std::string ask = R"({"to_pattern": {"points": [[2, 3, 0]]}})";
        int read = 0;
        const auto pattern = [&] {
            ++read;
            return obj;
        };
        for (int i = 0; i < 3; ++i)
            CHECK(maps.map("a", pattern, ask).find("\"uv_mm\":[2.0,3.0]") != std::string::npos);
        CHECK(read == 1);
        for (const char* other : {"b", "c", "d", "e"}) (void)maps.map(other, pattern, ask);
        CHECK(read == 5);
        (void)maps.map("a", pattern, ask);
        CHECK(read == 6);
        CHECK(code_refused([&] { return maps.map("a", pattern, "{"); }) == "invalid_request");
    }
}

}  // namespace lastflat::server
