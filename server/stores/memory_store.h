// Jobs in memory: gone when the process ends.
#pragma once

#include <deque>
#include <map>
#include <mutex>

#include "server/stores/job_store.h"

namespace lastflat::server {

struct MemoryLimits {
    std::size_t queued_jobs = 256;
    std::size_t queued_bytes = 1024u << 20;  ///< models waiting or being worked on
    std::size_t result_bytes = 1024u << 20;  ///< then the oldest results expire
    std::size_t finished_jobs = 10'000;      ///< then the oldest jobs are forgotten
};

class MemoryStore final : public JobStore {
public:
    explicit MemoryStore(const MemoryLimits& limits) : limits_(limits) {}

    [[nodiscard]] bool add(const std::string& id, JobInput input) override;
    [[nodiscard]] std::optional<JobRecord> find(const std::string& id) const override;
    [[nodiscard]] std::optional<Claim> claim() override;
    void finish(const std::string& id, JobOutcome outcome) override;
    [[nodiscard]] std::optional<JobState> cancel(const std::string& id) override;
    [[nodiscard]] bool remove(const std::string& id) override;
    [[nodiscard]] JobCounts counts() const override;

private:
    struct Row {
        JobRecord record;
        JobInput input;  ///< emptied when the job ends
    };
    void change(Row& row, JobState to);
    void drop_input(Row& row);
    void expire_old();

    const MemoryLimits limits_;
    mutable std::mutex mutex_;
    std::map<std::string, Row> rows_;
    std::deque<std::string> queue_;     ///< queued, oldest first
    std::deque<std::string> finished_;  ///< oldest first; removed ones are skipped
    std::size_t running_ = 0, input_bytes_ = 0, result_bytes_ = 0;
};

}  // namespace lastflat::server
