#include "server/stores/memory_store.h"

#include <algorithm>
#include <stdexcept>

namespace lastflat::server {

void MemoryStore::change(Row& row, JobState to) {
    if (!may_become(row.record.state, to)) throw std::logic_error("a job cannot change like that");
    row.record.state = to;
    if (to == JobState::running) row.record.started_ms = now_ms();
    if (is_final(to)) {
        row.record.finished_ms = now_ms();
        drop_input(row);
        finished_.push_back(row.record.id);
    }
}

void MemoryStore::drop_input(Row& row) {
    if (row.input.model) input_bytes_ -= row.input.model->size();
    row.input = {};
}

bool MemoryStore::add(const std::string& id, JobInput input) {
    const std::scoped_lock lock(mutex_);
    const std::size_t bytes = input.model->size();
    if (queue_.size() >= limits_.queued_jobs || input_bytes_ + bytes > limits_.queued_bytes)
        return false;
    Row row;
    row.record.id = id;
    row.record.tag = input.tag;
    row.record.created_ms = now_ms();
    row.input = std::move(input);
    rows_.emplace(id, std::move(row));
    queue_.push_back(id);
    input_bytes_ += bytes;
    return true;
}

std::optional<JobRecord> MemoryStore::find(const std::string& id) const {
    const std::scoped_lock lock(mutex_);
    const auto row = rows_.find(id);
    if (row == rows_.end()) return std::nullopt;
    JobRecord record = row->second.record;
    if (record.state == JobState::queued) {
        const auto place = std::find(queue_.begin(), queue_.end(), id);
        record.queue_position = static_cast<std::size_t>(place - queue_.begin()) + 1;
    }
    return record;
}

std::optional<Claim> MemoryStore::claim() {
    const std::scoped_lock lock(mutex_);
    if (queue_.empty()) return std::nullopt;
    Row& row = rows_.at(queue_.front());
    queue_.pop_front();
    change(row, JobState::running);
    ++running_;
    return Claim{row.record.id, row.input};
}

void MemoryStore::finish(const std::string& id, JobOutcome outcome) {
    const std::scoped_lock lock(mutex_);
    --running_;
    const auto found = rows_.find(id);
    if (found == rows_.end()) return;
    Row& row = found->second;
    if (row.record.state == JobState::canceling) {
        change(row, JobState::canceled);
    } else if (outcome.output) {
        change(row, JobState::succeeded);
        result_bytes_ += outcome.output->size();
        row.record.output = std::move(outcome.output);
    } else {
        change(row, JobState::failed);
        row.record.error = std::move(outcome.error);
    }
    expire_old();
}

void MemoryStore::expire_old() {
    const auto forget_result = [&](Row& row) {
        if (!row.record.output) return;
        result_bytes_ -= row.record.output->size();
        row.record.output.reset();
    };
    for (const std::string& id : finished_) {
        // The newest stays even if it is larger than the limit by itself.
        if (result_bytes_ <= limits_.result_bytes || id == finished_.back()) break;
        if (const auto row = rows_.find(id); row != rows_.end()) forget_result(row->second);
    }
    while (finished_.size() > limits_.finished_jobs) {
        if (const auto row = rows_.find(finished_.front()); row != rows_.end()) {
            forget_result(row->second);
            rows_.erase(row);
        }
        finished_.pop_front();
    }
}

std::optional<JobState> MemoryStore::cancel(const std::string& id) {
    const std::scoped_lock lock(mutex_);
    const auto row = rows_.find(id);
    if (row == rows_.end()) return std::nullopt;
    if (row->second.record.state == JobState::queued) {
        std::erase(queue_, id);
        change(row->second, JobState::canceled);
    } else if (row->second.record.state == JobState::running) {
        change(row->second, JobState::canceling);
    }
    return row->second.record.state;
}

bool MemoryStore::remove(const std::string& id) {
    const std::scoped_lock lock(mutex_);
    const auto row = rows_.find(id);
    if (row == rows_.end()) return false;
    std::erase(queue_, id);
    std::erase(finished_, id);
    drop_input(row->second);
    if (row->second.record.output) result_bytes_ -= row->second.record.output->size();
    rows_.erase(row);
    return true;
}

JobCounts MemoryStore::counts() const {
    const std::scoped_lock lock(mutex_);
    return {queue_.size(), running_};
}

}  // namespace lastflat::server
