#include "server/runner/runner_pool.h"

#include "server/jobs/job_control.h"
#include "server/support/clock.h"

namespace lastflat::server {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds storage_pause{1000};
/// A row that another process has put into the queue is found at the latest then.
constexpr std::chrono::milliseconds look_again{2000};

/// How the job ends; nothing: it may be run again.
std::optional<JobEnd> end_of(const Claim& claim, Unfinished::Kind run) {
    switch (run) {
        case Unfinished::Kind::crashed:
            return Failed{{"worker_crashed",
                           "the program broke on this model; the service goes on. Send the model "
                           "to those who run it"}};
        case Unfinished::Kind::timed_out:
            return Failed{{"job_too_slow",
                           "the job took longer than a job may (the limit --job-time); send a "
                           "coarser model"}};
        case Unfinished::Kind::lost:
            if (claim.attempt < most_attempts) return std::nullopt;
            return Failed{worker_lost_problem()};
        case Unfinished::Kind::retry:
            if (claim.retries < most_retries) return std::nullopt;
            return Failed{{"storage_full",
                           "there was no room on the disk for the result, for an hour; post the "
                           "job again when there is"}};
        case Unfinished::Kind::stopped: return std::nullopt;
    }
    return std::nullopt;
}

std::optional<JobEnd> end_of(const Claim& claim, const ProcessEnd& run) {
    if (const auto* succeeded = std::get_if<Succeeded>(&run)) return *succeeded;
    if (const auto* failed = std::get_if<Failed>(&run)) return *failed;
    const auto* unfinished = std::get_if<Unfinished>(&run);
    return end_of(claim, unfinished != nullptr ? unfinished->kind : Unfinished::Kind::crashed);
}

Release why_released(const ProcessEnd& run) {
    const auto kind = std::get<Unfinished>(run).kind;
    if (kind == Unfinished::Kind::lost) return Release::lost;
    return kind == Unfinished::Kind::retry ? Release::later : Release::unfinished;
}

}  // namespace

RunnerPool::RunnerPool(JobStore& store, const BlobStore& blobs, JobWatch& watch,
                       PoolOptions options, RunJob run_job, RunLog log)
    : store_(store),
      blobs_(blobs),
      watch_(watch),
      options_(std::move(options)),
      run_job_(std::move(run_job)),
      log_(std::move(log)) {
    for (std::size_t i = 0; i < options_.workers; ++i) threads_.emplace_back([this] { work(); });
}

RunnerPool::~RunnerPool() {
    stop(std::chrono::milliseconds(0));
}

void RunnerPool::wake() {
    {
        const std::scoped_lock lock(mutex_);
        ++wakes_;
    }
    // All: threads that wait for something else would take a single call for theirs.
    changed_.notify_all();
}

void RunnerPool::cancel(JobNumber job) {
    const std::scoped_lock lock(mutex_);
    for (auto& [token, run] : running_) {
        if (run.job == job) run.canceled = true;
    }
}

std::size_t RunnerPool::busy() const {
    const std::scoped_lock lock(mutex_);
    return running_.size();
}

void RunnerPool::drain() {
    const std::scoped_lock lock(mutex_);
    draining_ = true;
    changed_.notify_all();
}

void RunnerPool::stop(std::chrono::milliseconds grace) {
    drain();
    {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, grace, [&] { return running_.empty(); });
        stopping_ = true;
        changed_.notify_all();
    }
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
}

void RunnerPool::work() {
    std::unique_lock lock(mutex_);
    while (!draining_) {
        // The store may be slow: what others want of this pool must not wait for it.
        const std::uint64_t seen = wakes_;
        lock.unlock();
        std::optional<Claim> claim = try_claim();
        lock.lock();
        if (!claim) {
            changed_.wait_for(lock, look_again, [&] { return draining_ || wakes_ != seen; });
            continue;
        }
        running_.emplace(claim->lease.token, Run{claim->lease.job});
        lock.unlock();
        watch_.changed(claim->lease.job);
        try {
            run(*claim);
        } catch (const std::exception& error) {
            // The lease will end, and the job be begun again.
            log_({*claim, "lost", error.what(), 0.0, {}});
        }
        lock.lock();
        running_.erase(claim->lease.token);
        changed_.notify_all();
    }
}

std::optional<Claim> RunnerPool::try_claim() {
    try {
        return store_.claim(options_.lease_ms);
    } catch (const std::exception&) {
        return std::nullopt;  // it shows in every request; here it only means: later
    }
}

bool RunnerPool::must_stop(const Claim& claim, std::int64_t& renewed_ms) {
    {
        const std::scoped_lock lock(mutex_);
        if (stopping_ || running_.at(claim.lease.token).canceled) return true;
    }
    const std::int64_t age = now_ms() - renewed_ms;
    if (age < options_.lease_ms / 3) return false;
    try {
        if (store_.renew(claim.lease, options_.lease_ms) != Hold::held) return true;
        renewed_ms = now_ms();
    } catch (const StoreError&) {
        return age > options_.lease_ms;  // by then somebody else may have it
    }
    return false;
}

void RunnerPool::run(const Claim& claim) {
    const auto begun = Clock::now();
    auto stage_begun = begun;
    std::string stage = "start";
    RunReport report;
    report.claim = claim;
    // The first look renews: a cancel may have come before this run was known.
    std::int64_t renewed_ms = now_ms() - options_.lease_ms / 3;
    const ProcessControl control{[&](const std::string& next, double fraction) {
                                     const auto now = Clock::now();
                                     report.stage_seconds[stage] +=
                                         std::chrono::duration<double>(now - stage_begun).count();
                                     stage = next;
                                     stage_begun = now;
                                     watch_.reach(claim.lease.job, next, fraction);
                                 },
                                 [&] { return must_stop(claim, renewed_ms); }};
    const std::filesystem::path file =
        options_.work / (std::to_string(claim.lease.job) + "." + std::to_string(claim.attempt));
    ProcessEnd end;
    try {
        end = run_job_(claim, file, control);
    } catch (const std::exception& error) {
        end = Unfinished{Unfinished::Kind::retry, error.what()};
    }
    if (const auto* unfinished = std::get_if<Unfinished>(&end)) report.why = unfinished->why;
    const auto state = settle(claim, end, file);
    report.outcome = state ? name(*state) : "lost";
    std::error_code gone;
    std::filesystem::remove(file, gone);
    report.seconds = std::chrono::duration<double>(Clock::now() - begun).count();
    watch_.ended(claim.lease.job);
    watch_.changed(claim.lease.job);
    log_(report);
}

bool RunnerPool::persist(const std::function<void()>& change) {
    for (;;) {
        try {
            change();
            return true;
        } catch (const StoreError&) {
            // The lease may end meanwhile: then the change is refused, and that is right.
            std::unique_lock lock(mutex_);
            if (changed_.wait_for(lock, storage_pause, [&] { return stopping_; })) return false;
        }
    }
}

std::optional<JobState> RunnerPool::settle(const Claim& claim, const ProcessEnd& run,
                                           const std::filesystem::path& file) {
    std::optional<JobState> state;
    const auto end = end_of(claim, run);
    const auto* succeeded = end ? std::get_if<Succeeded>(&*end) : nullptr;
    const bool kept = persist([&] {
        const auto pin = blobs_.pin();
        if (!end) {
            state = store_.release(claim.lease, why_released(run));
            return;
        }
        if (succeeded != nullptr) blobs_.adopt(file, succeeded->result);
        state = store_.finish(claim.lease, *end);
    });
    if (!kept) return std::nullopt;
    std::vector<std::string> blobs{claim.model};
    if (succeeded != nullptr) blobs.push_back(succeeded->result);
    try {
        drop_unneeded(blobs_, store_, blobs);
    } catch (const StoreError&) {
        // They stay until the next start sweeps them.
    }
    return state;
}

}  // namespace lastflat::server
