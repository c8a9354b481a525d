// Format: Prometheus, "Text-based format", version 0.0.4.
#include "server/support/metrics.h"

#include <array>
#include <cstdio>

namespace lastflat::server {
namespace {

struct Description {
    std::string_view name, type, help;
};

constexpr std::array descriptions{
    Description{"lastflat_http_requests_total", "counter", "Answers by route and status."},
    Description{"lastflat_http_request_seconds", "histogram",
                "From the head to the answer's last byte, by route."},
    Description{"lastflat_http_received_bytes_total", "counter", "Bytes of bodies received."},
    Description{"lastflat_http_sent_bytes_total", "counter", "Bytes of answers sent."},
    Description{"lastflat_jobs_ended_total", "counter", "Runs of jobs by how they ended."},
    Description{"lastflat_job_seconds", "histogram", "Duration of runs by outcome."},
    Description{"lastflat_job_stage_seconds", "histogram", "Duration of the stages of runs."},
    Description{"lastflat_jobs_queued", "gauge", "Jobs waiting."},
    Description{"lastflat_queue_age_seconds", "gauge", "Age of the oldest job waiting."},
    Description{"lastflat_jobs_running", "gauge", "Jobs running."},
    Description{"lastflat_workers", "gauge", "Workers there are."},
    Description{"lastflat_workers_busy", "gauge", "Workers at work."},
    Description{"lastflat_stored_bytes", "gauge", "Bytes of models and results on the disk."},
    Description{"lastflat_disk_free_bytes", "gauge", "Room on that disk."},
    Description{"lastflat_sqlite_seconds", "histogram", "Duration of transactions by kind."},
    Description{"lastflat_store_failures_total", "counter", "Transactions that failed."},
};

constexpr std::array bounds{0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0};

std::string label_text(const Labels& labels) {
    std::string text;
    for (const auto& [name, value] : labels) {
        if (!text.empty()) text += ",";
        text.append(name).append("=\"");
        for (const char c : value) {
            if (c == '\\' || c == '"') text += '\\';
            if (c == '\n')
                text += "\\n";
            else
                text += c;
        }
        text += "\"";
    }
    return text;
}

std::string number_text(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.10g", value);
    return text.data();
}

void line(std::string& out, const std::string& name, const std::string& labels, double value) {
    out += name;
    if (!labels.empty()) out += "{" + labels + "}";
    out += " " + number_text(value) + "\n";
}

}  // namespace

void Metrics::count(std::string_view name, const Labels& labels, double by) {
    const std::scoped_lock lock(mutex_);
    values_[{std::string(name), label_text(labels)}] += by;
}

void Metrics::set(std::string_view name, double value, const Labels& labels) {
    const std::scoped_lock lock(mutex_);
    values_[{std::string(name), label_text(labels)}] = value;
}

void Metrics::observe(std::string_view name, double seconds, const Labels& labels) {
    const std::scoped_lock lock(mutex_);
    Histogram& histogram = histograms_[{std::string(name), label_text(labels)}];
    histogram.counts.resize(bounds.size());
    for (std::size_t i = 0; i < bounds.size(); ++i) {
        if (seconds <= bounds[i]) ++histogram.counts[i];
    }
    histogram.sum += seconds;
    ++histogram.total;
}

std::string Metrics::text() const {
    const std::scoped_lock lock(mutex_);
    std::string out;
    for (const Description& about : descriptions) {
        const std::string name(about.name);
        out += "# HELP " + name + " " + std::string(about.help) + "\n";
        out += "# TYPE " + name + " " + std::string(about.type) + "\n";
        for (const auto& [series, value] : values_) {
            if (series.first == name) line(out, name, series.second, value);
        }
        for (const auto& [series, histogram] : histograms_) {
            if (series.first != name) continue;
            const std::string comma = series.second.empty() ? "" : series.second + ",";
            for (std::size_t i = 0; i < bounds.size(); ++i) {
                line(out, name + "_bucket", comma + "le=\"" + number_text(bounds[i]) + "\"",
                     static_cast<double>(histogram.counts[i]));
            }
            line(out, name + "_bucket", comma + "le=\"+Inf\"",
                 static_cast<double>(histogram.total));
            line(out, name + "_sum", series.second, histogram.sum);
            line(out, name + "_count", series.second, static_cast<double>(histogram.total));
        }
    }
    return out;
}

}  // namespace lastflat::server
