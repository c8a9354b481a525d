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
        const auto expected = run_job(input, progress);
        input.options.threads = 2;
        std::array<JobOutput, 3> outputs;
        std::vector<std::thread> threads;
        for (JobOutput& output : outputs) {
            threads.emplace_back([&] {
                Progress own;
                output = run_job(input, own);
            });
        }
        for (std::thread& thread : threads) thread.join();
        for (const JobOutput& output : outputs) {
            CHECK(output.svg == expected.svg);
        }
    }

    TEST_CASE("a bare last is the same on two threads as on one") {
        JobInput input{write_model_obj(make_sample_last().mesh), {}};
        Progress progress;
        const auto expected = run_job(input, progress);
        input.options.threads = 2;
        Progress again;
        const auto output = run_job(input, again);
        CHECK(output.svg == expected.svg);
        CHECK(output.obj == expected.obj);
    }
}

}  // namespace lastflat::server
