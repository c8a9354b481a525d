// Numbers for those who operate the service, in Prometheus' text format.
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace lastflat::server {

/// `name="value"` pairs; the names are ours, the values are escaped.
using Labels = std::vector<std::pair<std::string_view, std::string_view>>;

/// Safe from any thread. Names and help texts stand in metrics.cpp, one table for all.
class Metrics {
public:
    void count(std::string_view name, const Labels& labels = {}, double by = 1.0);
    /// Adds to a histogram.
    void observe(std::string_view name, double seconds, const Labels& labels = {});
    void set(std::string_view name, double value, const Labels& labels = {});

    [[nodiscard]] std::string text() const;

private:
    struct Histogram {
        std::vector<std::size_t> counts;
        double sum = 0.0;
        std::size_t total = 0;
    };
    using Series = std::pair<std::string, std::string>;  ///< name, labels as text

    mutable std::mutex mutex_;
    std::map<Series, double> values_;
    std::map<Series, Histogram> histograms_;
};

}  // namespace lastflat::server
