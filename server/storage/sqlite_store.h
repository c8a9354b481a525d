// Jobs in SQLite.
#pragma once

#include "server/jobs/job_store.h"
#include "server/storage/sqlite.h"

namespace lastflat::server {

class SqliteStore final : public JobStore {
public:
    /// The database must outlive the store.
    SqliteStore(SqliteDatabase& database, const Retention& retention)
        : database_(database), retention_(retention) {}

    [[nodiscard]] Admitted add(const NewJob& job, const QueueLimits& limits) override;
    [[nodiscard]] Admitted add(const NewBatch& batch, const QueueLimits& limits) override;
    [[nodiscard]] std::string answer(const NewJob& job) override;
    [[nodiscard]] std::optional<BatchRecord> find_batch(const std::string& owner,
                                                        const std::string& id) override;
    [[nodiscard]] std::optional<JobRecord> find(const std::string& owner,
                                                const std::string& id) override;
    [[nodiscard]] bool is_expired(const std::string& owner, const std::string& id) override;
    [[nodiscard]] JobList list(const std::string& owner, const JobFilter& filter) override;
    [[nodiscard]] std::vector<StateChange> history(JobNumber job, std::int64_t after) override;
    [[nodiscard]] JobCounts counts() override;
    [[nodiscard]] std::optional<Claim> claim(std::int64_t lease_ms) override;
    [[nodiscard]] Hold renew(const Lease& lease, std::int64_t lease_ms) override;
    [[nodiscard]] std::optional<JobState> finish(const Lease& lease, const JobEnd& end) override;
    [[nodiscard]] std::optional<JobState> release(const Lease& lease, Release why) override;
    [[nodiscard]] std::optional<JobState> cancel(const std::string& owner,
                                                 const std::string& id) override;
    [[nodiscard]] std::optional<std::vector<std::string>> remove(const std::string& owner,
                                                                 const std::string& id) override;
    [[nodiscard]] Swept sweep(bool all_leases, const api::Problem& lost) override;
    [[nodiscard]] bool needs_blob(const std::string& digest) override;
    [[nodiscard]] bool has_blob(const std::string& owner, const std::string& digest) override;

private:
    SqliteDatabase& database_;
    const Retention retention_;
};

}  // namespace lastflat::server
