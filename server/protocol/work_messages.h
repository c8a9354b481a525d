// What the service and a worker say to each other: one message a line.
//
//   service -> worker   the order, as JSON
//   worker -> service   progress {"stage": "cut", "fraction": 0.2}   any number of times
//                       result {"digest": "...", "parts": [...]}     the end: in `order.result`
//                       problem {...}                                the end: the job has failed
//                       report {...}                                 the end of any other task
//                       retry why                                    the end: not the job's fault
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "server/jobs/job.h"

namespace lastflat::server {

enum class Task {
    flatten,
    inspect,      ///< only load and check
    thumbnail,    ///< a picture as wide as `request` says; the model is a result's SVG
    session,      ///< until its input ends; its messages are others (`session_messages.h`)
    resident_map  ///< likewise; `map` alone is asked; the model is a result's OBJ
};

struct WorkOrder {
    Task task = Task::flatten;
    std::string model;    ///< path
    std::string digest;   ///< of the model
    std::string request;  ///< constraint JSON, or a number
    std::string result;   ///< path of the file to write
    int threads = 1;
    int memory_mb = 0;    ///< 0: no limit
    int cpu_seconds = 0;  ///< 0: no limit
    int parent = 0;       ///< process that ordered it: the worker ends with it
};

[[nodiscard]] std::string to_line(const WorkOrder& order);
/// Throws: nlohmann::json::exception.
[[nodiscard]] WorkOrder work_order_of(std::string_view line);

struct StageReached {
    std::string stage;
    double fraction;  ///< of the whole job
};
/// What the answer holds, on one line: JSON, or a picture's base64.
struct Report {
    std::string content;
};
struct Retry {
    std::string why;
};
using WorkMessage = std::variant<StageReached, Succeeded, Failed, Report, Retry>;

[[nodiscard]] std::string to_line(const WorkMessage& message);
/// Nothing if the line is no message.
[[nodiscard]] std::optional<WorkMessage> work_message_of(std::string_view line);

}  // namespace lastflat::server
