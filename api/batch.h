// Many jobs that are one thing.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/job.h"
#include "api/submission.h"

namespace lastflat::api {

inline constexpr std::size_t most_batch_jobs = 200;

/// The body of POST /v1/jobs:batch. Each job is read when its turn comes: their models are not all
/// in memory at once.
class BatchRequest {
public:
    /// Throws: InvalidRequest naming the field, also if there is no job.
    explicit BatchRequest(std::string_view text);
    [[nodiscard]] std::size_t size() const;
    /// Throws: InvalidRequest naming the field of this job.
    [[nodiscard]] JsonSubmission job(std::size_t index) const;

private:
    nlohmann::json document_;
};

struct Batch {
    std::string id;
    std::int64_t created_ms = 0;
    std::optional<std::int64_t> finished_ms;
    std::size_t size = 0;                    ///< jobs that were sent
    std::map<JobState, std::size_t> states;  ///< how many of those that are left are in each
    std::vector<Job> items;                  ///< those that are left, in their order
};
[[nodiscard]] std::string to_json(const Batch& batch);

}  // namespace lastflat::api
