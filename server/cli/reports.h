// What happens, told to the log and the metrics.
#pragma once

#include "server/http/http.h"
#include "server/jobs/estimate.h"
#include "server/runner/runner_pool.h"
#include "server/storage/sqlite.h"
#include "server/support/metrics.h"

namespace lastflat::server {

/// Of every answer. All that is referred to must outlive what is returned.
[[nodiscard]] http::AnswerLog answer_log(Metrics& metrics);
/// Of every end of a run; successes are remembered for the estimate.
[[nodiscard]] RunLog run_log(Metrics& metrics, Estimate& estimate);
[[nodiscard]] SqliteClock sqlite_clock(Metrics& metrics);

}  // namespace lastflat::server
