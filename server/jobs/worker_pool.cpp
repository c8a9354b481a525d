#include "server/jobs/worker_pool.h"

namespace lastflat::server {

WorkerPool::WorkerPool(JobStore& store, JobRunner runner, std::size_t workers)
    : store_(store), runner_(std::move(runner)) {
    for (std::size_t i = 0; i < workers; ++i) threads_.emplace_back([this] { work(); });
}

WorkerPool::~WorkerPool() {
    (void)stop(std::chrono::milliseconds(0), std::chrono::milliseconds(0));
    for (std::thread& thread : threads_) thread.join();
}

void WorkerPool::wake() {
    // Taking the lock orders this after a worker's look at the store, so that no job is missed.
    { const std::scoped_lock lock(mutex_); }
    changed_.notify_one();
}

void WorkerPool::cancel(const std::string& id) {
    const std::scoped_lock lock(mutex_);
    if (const auto job = running_.find(id); job != running_.end()) job->second->cancel();
}

std::optional<std::pair<Stage, double>> WorkerPool::progress(const std::string& id) const {
    const std::scoped_lock lock(mutex_);
    const auto job = running_.find(id);
    if (job == running_.end()) return std::nullopt;
    return std::pair(job->second->stage(), job->second->fraction());
}

void WorkerPool::work() {
    std::unique_lock lock(mutex_);
    while (!stopping_) {
        auto claim = store_.claim();
        if (!claim) {
            changed_.wait(lock);
            continue;
        }
        const auto progress = std::make_shared<Progress>();
        running_.emplace(claim->id, progress);
        lock.unlock();
        JobOutcome outcome = runner_(claim->input, *progress);
        store_.finish(claim->id, std::move(outcome));
        const std::string id = std::move(claim->id);
        claim.reset();  // frees the model before the next wait
        lock.lock();
        running_.erase(id);
        changed_.notify_all();
    }
}

bool WorkerPool::stop(std::chrono::milliseconds grace, std::chrono::milliseconds last_grace) {
    std::unique_lock lock(mutex_);
    const auto idle = [&] { return running_.empty(); };
    stopping_ = true;
    changed_.notify_all();
    if (changed_.wait_for(lock, grace, idle)) return true;
    for (const auto& [id, progress] : running_) {
        (void)store_.cancel(id);
        progress->cancel();
    }
    return changed_.wait_for(lock, last_grace, idle);
}

}  // namespace lastflat::server
