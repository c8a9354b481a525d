// Jobs side by side, each on two threads: for the thread sanitizer.
#include <doctest/doctest.h>

#include "server/jobs/worker_pool.h"
#include "server/run_job.h"
#include "server/stores/memory_store.h"
#include "tests/helpers/sample.h"

namespace lastflat::server {

TEST_SUITE("server/parallel") {
    TEST_CASE("jobs that run side by side give what one gives alone") {
        const SampleLast last = make_sample_last();
        const auto model = std::make_shared<const std::string>(write_model_obj(last.mesh));
        FlattenOptions options = test::sample_options(last);
        Progress progress;
        const FlattenResult expected = flatten(*model, options, progress);
        options.threads = 2;
        MemoryStore store({});
        WorkerPool pool(store, run_job, 2);
        for (const char* id : {"A", "B", "C"}) {
            REQUIRE(store.add(id, {model, options, ""}));
            pool.wake();
        }
        for (const char* id : {"A", "B", "C"}) {
            while (!is_final(store.find(id)->state)) {
                (void)pool.progress(id);
                std::this_thread::yield();
            }
            const JobRecord job = *store.find(id);
            REQUIRE(job.output);
            CHECK(*job.output->svg == *render(expected)->svg);
        }
    }
}

}  // namespace lastflat::server
