// What a whole batch came to, for a spreadsheet and for programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "api/job.h"

namespace lastflat::api {

/// One row for every curve and piece of every job that has a result, one for every other job
/// (RFC 4180). A text that a spreadsheet would take for a formula begins with an apostrophe.
class BatchTable {
public:
    /// `metrics`: the job's, as JSON; empty: it has none.
    void add(const Job& job, std::string_view metrics);
    [[nodiscard]] const std::string& text() const { return text_; }

private:
    std::string text_ =
        "job,tag,state,error,region,curve,locked,last_mm,flat_mm,flat_minus_last_mm,percent,"
        "worst_edge_error_mm,verdict\r\n";
};

/// Jobs of a batch without a result, and why.
class BatchErrors {
public:
    void add(const Job& job, const Problem& problem);
    [[nodiscard]] std::string json() const;

private:
    nlohmann::ordered_json items_ = nlohmann::ordered_json::array();
};

}  // namespace lastflat::api
