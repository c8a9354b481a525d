// The real program as a worker: it is run, misused and killed.
#include "server/runner/worker_process.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>

#include "server/protocol/result_pack.h"
#include "server/storage/blob_folder.h"
#include "server/support/crypto.h"
#include "server/support/files.h"
#include "tests/helpers/temporary_folder.h"

namespace lastflat::server {
namespace {

constexpr char square[] = "v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nf 1 2 3 4\n";

struct WorkSetting {
    lastflat::test::TemporaryFolder folder;
    ProcessLimits limits;
    std::vector<std::string> stages;

    WorkSetting() {
        if (const char* program = std::getenv("LASTFLAT"))
            limits.program = std::filesystem::path(program).replace_filename("lastflat-work");
    }

    WorkOrder order(const std::string& model, const std::string& request = "") const {
        WorkOrder order;
        order.model = folder.path() / "model";
        order.digest = sha256(model);
        order.request = request;
        order.result = folder.path() / "result";
        write_durably(order.model, model);
        return order;
    }
    ProcessEnd run(
        const WorkOrder& order, std::function<bool()> must_stop = [] { return false; }) {
        return run_worker_process(
            order, limits,
            {[this](const std::string& stage, double) { stages.push_back(stage); }, must_stop});
    }
};

std::string code_of(const ProcessEnd& end) {
    return std::string(std::get<Failed>(end).problem.code.word());
}

/// A program that is no worker.
std::string script(const WorkSetting& s, const std::string& body) {
    const auto path = s.folder.path() / "script";
    std::ofstream(path) << "#!/bin/sh\n" << body << "\n";
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
    return path;
}

}  // namespace

TEST_SUITE("server/runner/worker_process") {
    TEST_CASE("a job comes back with every format, plain and compressed, each checked") {
        WorkSetting s;
        REQUIRE(std::filesystem::exists(s.limits.program));
        const ProcessEnd end = s.run(s.order(square));
        REQUIRE(std::holds_alternative<Succeeded>(end));
        const auto& [result, parts] = std::get<Succeeded>(end);
        REQUIRE(parts.size() == 5);
        CHECK(s.stages.front() == "load");
        CHECK(s.stages.back() == "done");
        const File file(s.folder.path() / "result", 0);
        CHECK(sha256(file.read(0, file.size())) == result);
        for (const ResultPart& part : parts)
            CHECK(sha256(file.read(part.offset, part.size)) == part.digest);
    }

    TEST_CASE("what is wrong with a job comes back as its problem") {
        WorkSetting s;
        CHECK(code_of(s.run(s.order("hello"))) == "unreadable_model");
        CHECK(code_of(s.run(s.order(square, "{\"cut\": []}"))) == "invalid_request");
        WorkOrder changed = s.order(square);
        write_durably(changed.model, "other bytes");
        CHECK(code_of(s.run(changed)) == "model_lost");
    }

    TEST_CASE("an inspection comes back with a report") {
        WorkSetting s;
        WorkOrder order = s.order(square);
        order.task = Task::inspect;
        CHECK(std::get<Report>(s.run(order)).content.find("\"flattens\":true") !=
              std::string::npos);
        order = s.order("hello");
        order.task = Task::inspect;
        CHECK(code_of(s.run(order)) == "unreadable_model");
    }

    TEST_CASE("a process that crashes, talks nonsense, hangs or is killed takes nothing with it") {
        WorkSetting s;
        s.limits.time = std::chrono::milliseconds(300);
        const auto kind = [&](const std::string& body) {
            s.limits.program = script(s, body);
            return std::get<Unfinished>(s.run(s.order(square))).kind;
        };
        using Kind = Unfinished::Kind;
        CHECK(kind("kill -SEGV $$") == Kind::crashed);
        CHECK(kind("kill -KILL $$") == Kind::lost);
        CHECK(kind("kill -XCPU $$") == Kind::timed_out);
        CHECK(kind("exit 0") == Kind::crashed);
        CHECK(kind("echo nonsense; sleep 10") == Kind::crashed);
        CHECK(kind("echo 'progress {\"stage\": 7}'") == Kind::crashed);
        CHECK(kind("exec sleep 10") == Kind::timed_out);
        CHECK(kind("exec >&- 2>&-; exec sleep 60") == Kind::lost);
        CHECK(kind("echo 'retry the disk is full'") == Kind::retry);
        CHECK(std::get<Unfinished>(s.run(s.order(square), [] { return true; })).kind ==
              Kind::stopped);
        s.limits.program = "/nowhere";
        CHECK_THROWS((void)s.run(s.order(square)));
    }

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    TEST_CASE("a job that wants more memory than it may have says so") {
        WorkSetting s;
        s.limits.memory_mb = 40;
        std::string model;
        for (int i = 0; i < 1'500'000; ++i) model += "v " + std::to_string(i) + " 0 0\n";
        const ProcessEnd end = s.run(s.order(model + "f 1 2 3\n"));
        CHECK(code_of(end) == "out_of_memory");
    }
#endif
}

}  // namespace lastflat::server
