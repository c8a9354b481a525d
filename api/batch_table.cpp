#include "api/batch_table.h"

#include "api/json.h"
#include "core/text.h"

namespace lastflat::api {
namespace {

constexpr int length_decimals = 6;

/// A cell of text. What begins as a formula does would be run as one.
std::string cell(std::string text) {
    if (text.find_first_of("=+-@\t\r") == 0) text.insert(0, 1, '\'');
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
}

std::string number(double value) {
    return fixed_text(value, length_decimals);
}

std::string row_of(const nlohmann::json& region, const nlohmann::json& curve) {
    const double last = curve.at("length_3d_mm"), flat = curve.at("length_2d_mm");
    const double percent = last > 0.0 ? 100.0 * (flat - last) / last : 0.0;
    return cell(region.at("name")) + "," + cell(curve.at("name")) + "," +
           (curve.at("locked").get<bool>() ? "yes" : "no") + "," + number(last) + "," +
           number(flat) + "," + number(flat - last) + "," + number(percent) + "," +
           number(curve.at("worst_edge_error_mm")) + "," + curve.value("verdict", "") + "\r\n";
}

}  // namespace

void BatchTable::add(const Job& job, std::string_view metrics) {
    const std::string begin =
        job.id + "," + cell(job.tag) + "," + std::string(word_of(job_states, job.state)) + ",";
    if (metrics.empty()) {
        text_ += begin + (job.error ? std::string(job.error->code.word()) : job.reason) +
                 ",,,,,,,,,\r\n";
        return;
    }
    const auto document = nlohmann::json::parse(metrics);
    for (const auto& region : document.at("regions")) {
        for (const auto& curve : region.at("curves")) text_ += begin + "," + row_of(region, curve);
    }
}

void BatchErrors::add(const Job& job, const Problem& problem) {
    Json item{{"job", job.id}, {"state", word_of(job_states, job.state)}};
    if (!job.tag.empty()) item["tag"] = job.tag;
    item["problem"] = json_of(problem);
    items_.push_back(std::move(item));
}

std::string BatchErrors::json() const {
    return text_of({{"items", items_}}, 2);
}

}  // namespace lastflat::api
