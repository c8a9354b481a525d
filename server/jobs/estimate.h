// How long a job will take, from those that ended before it.
#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>

namespace lastflat::server {

/// Safe from any thread.
class Estimate {
public:
    void note(std::uint64_t model_bytes, double seconds);
    /// The median of the last jobs with models of about that size; nothing while there are fewer
    /// than three: a guess would not be honest.
    [[nodiscard]] std::optional<double> seconds(std::uint64_t model_bytes) const;
    /// The median of all of the last jobs.
    [[nodiscard]] std::optional<double> seconds() const;

private:
    struct Run {
        std::uint64_t bytes;
        double seconds;
    };
    mutable std::mutex mutex_;
    std::deque<Run> runs_;
};

}  // namespace lastflat::server
