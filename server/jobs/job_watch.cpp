#include "server/jobs/job_watch.h"

namespace lastflat::server {

void JobWatch::touch(Entry& entry) {
    ++entry.version;
    if (entry.subscriptions > 0) changed_.notify_all();
}

void JobWatch::drop_if_idle(std::map<JobNumber, Entry>::iterator entry) {
    if (entry->second.subscriptions == 0 && !entry->second.progress) entries_.erase(entry);
}

void JobWatch::changed(JobNumber job) {
    const std::scoped_lock lock(mutex_);
    if (const auto entry = entries_.find(job); entry != entries_.end()) touch(entry->second);
}

void JobWatch::reach(JobNumber job, const std::string& stage, double fraction) {
    const std::scoped_lock lock(mutex_);
    Entry& entry = entries_[job];
    const std::int64_t number = entry.progress ? entry.progress->number + 1 : 1;
    entry.progress = LiveProgress{stage, fraction, number};
    touch(entry);
}

void JobWatch::ended(JobNumber job) {
    const std::scoped_lock lock(mutex_);
    const auto entry = entries_.find(job);
    if (entry == entries_.end()) return;
    entry->second.progress.reset();
    touch(entry->second);
    drop_if_idle(entry);
}

std::optional<LiveProgress> JobWatch::progress(JobNumber job) const {
    const std::scoped_lock lock(mutex_);
    const auto entry = entries_.find(job);
    return entry == entries_.end() ? std::nullopt : entry->second.progress;
}

void JobWatch::close(std::chrono::milliseconds grace) {
    std::unique_lock lock(mutex_);
    closed_ = true;
    changed_.notify_all();
    changed_.wait_for(lock, grace, [&] { return subscriptions_ == 0; });
}

bool JobWatch::is_closed() const {
    const std::scoped_lock lock(mutex_);
    return closed_;
}

JobWatch::Subscription::Subscription(JobWatch& watch, JobNumber job) : watch_(watch), job_(job) {
    const std::scoped_lock lock(watch_.mutex_);
    Entry& entry = watch_.entries_[job_];
    ++entry.subscriptions;
    ++watch_.subscriptions_;
    seen_ = entry.version;
}

JobWatch::Subscription::~Subscription() {
    const std::scoped_lock lock(watch_.mutex_);
    const auto entry = watch_.entries_.find(job_);
    --entry->second.subscriptions;
    watch_.drop_if_idle(entry);
    if (--watch_.subscriptions_ == 0) watch_.changed_.notify_all();
}

bool JobWatch::Subscription::wait_until(Clock::time_point deadline) {
    std::unique_lock lock(watch_.mutex_);
    const Entry& entry = watch_.entries_.at(job_);
    const auto is_news = [&] { return watch_.closed_ || entry.version != seen_; };
    const bool news = watch_.changed_.wait_until(lock, deadline, is_news) && !watch_.closed_;
    seen_ = entry.version;
    return news;
}

}  // namespace lastflat::server
