// Jobs side by side, each on two threads: for the thread sanitizer.
#include <doctest/doctest.h>

#include <thread>

#include "server/worker/run_job.h"
#include "tests/helpers/sample.h"

namespace lastflat::server {

TEST_SUITE("server/worker/parallel") {
    TEST_CASE("jobs that run side by side give what one gives alone") {
        const SampleLast last = make_sample_last();
        JobInput input{write_model_obj(last.mesh), test::sample_options(last)};
        Progress progress;
        const auto expected = run_job(input, Compression::none, progress);
        REQUIRE(expected.output);
        input.options.threads = 2;
        std::array<RunOutcome, 3> outcomes;
        std::vector<std::thread> threads;
        for (RunOutcome& outcome : outcomes) {
            threads.emplace_back([&] {
                Progress own;
                outcome = run_job(input, Compression::gzip, own);
            });
        }
        for (std::thread& thread : threads) thread.join();
        for (const RunOutcome& outcome : outcomes) {
            REQUIRE(outcome.output);
            CHECK(outcome.output->svg.bytes == expected.output->svg.bytes);
        }
    }
}

}  // namespace lastflat::server
