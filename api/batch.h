// Many jobs in one request.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/job.h"
#include "api/submission.h"

namespace lastflat::api {

inline constexpr std::size_t most_batch_jobs = 200;

/// The body of POST /v1/jobs:batch. Each job is read when its turn comes: one that is wrong is no
/// reason to refuse the others, and their models are not all in memory at once.
class BatchRequest {
public:
    /// Throws: InvalidRequest naming the field.
    explicit BatchRequest(std::string_view text);
    [[nodiscard]] std::size_t size() const;
    /// Throws: InvalidRequest; its pointer begins at this job.
    [[nodiscard]] JsonSubmission job(std::size_t index) const;

private:
    nlohmann::json document_;
};

/// What became of each job, in their order.
struct Batch {
    struct Item {
        int status;
        std::variant<Job, Problem> outcome;
    };
    std::string id;
    std::vector<Item> items;
};
[[nodiscard]] std::string to_json(const Batch& batch);

struct BatchState {
    std::string id;
    std::vector<Job> items;
};
[[nodiscard]] std::string to_json(const BatchState& batch);

}  // namespace lastflat::api
