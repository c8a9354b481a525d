#include "server/jobs/estimate.h"

#include <algorithm>
#include <vector>

namespace lastflat::server {
namespace {

constexpr std::size_t most_runs = 128;
constexpr std::size_t fewest_runs = 3;
constexpr double size_factor = 2.0;

std::optional<double> median(std::vector<double> values) {
    if (values.size() < fewest_runs) return std::nullopt;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

void Estimate::note(std::uint64_t model_bytes, double seconds) {
    const std::scoped_lock lock(mutex_);
    runs_.push_back({model_bytes, seconds});
    if (runs_.size() > most_runs) runs_.pop_front();
}

std::optional<double> Estimate::seconds(std::uint64_t model_bytes) const {
    const std::scoped_lock lock(mutex_);
    std::vector<double> alike;
    const auto size = static_cast<double>(model_bytes);
    for (const Run& run : runs_) {
        const auto other = static_cast<double>(run.bytes);
        if (other <= size * size_factor && size <= other * size_factor)
            alike.push_back(run.seconds);
    }
    return median(std::move(alike));
}

std::optional<double> Estimate::seconds() const {
    const std::scoped_lock lock(mutex_);
    std::vector<double> all;
    for (const Run& run : runs_) all.push_back(run.seconds);
    return median(std::move(all));
}

}  // namespace lastflat::server
