// What the service and a worker say to each other: one JSON object a line.
//
//   service -> worker   the order
//   worker -> service   {"stage": "cut", "fraction": 0.2}            any number of times
//                       {"digest": "...", "parts": [...]}            the end: a result in `result`
//                       {"problem": {...}}                           the end: the job has failed
//                       {"report": {...}}                            the end of any other task
//                       {"retry": "why"}                             the end: not the job's fault
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "server/jobs/job.h"

namespace lastflat::server {

enum class Task {
    flatten,
    inspect,  ///< only load and check
    map       ///< between last and pattern; the model is a result's OBJ
};

struct WorkOrder {
    Task task = Task::flatten;
    std::string model;    ///< path
    std::string digest;   ///< of the model
    std::string request;  ///< constraint JSON, or what to map
    std::string result;   ///< path of the file to write
    int threads = 1;
    int memory_mb = 0;    ///< 0: no limit
    int cpu_seconds = 0;  ///< 0: no limit
    int parent = 0;       ///< process that ordered it: the worker ends with it
};

[[nodiscard]] std::string to_line(const WorkOrder& order);
/// Throws: nlohmann::json::exception.
[[nodiscard]] WorkOrder work_order_of(std::string_view line);

/// One message of a worker: exactly one of the members is given.
struct WorkMessage {
    std::optional<std::pair<std::string, double>> progress;
    std::optional<JobOutcome> outcome;
    std::optional<std::string> report, retry;
};

/// Nothing if the line is no message.
[[nodiscard]] std::optional<WorkMessage> work_message_of(std::string_view line);

}  // namespace lastflat::server
