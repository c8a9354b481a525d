#include "api/job_event.h"

#include "api/json.h"
#include "api/timestamp.h"

namespace lastflat::api {

std::string to_json(const StateEvent& event) {
    return text_of({{"state", word_of(job_states, event.state)},
                    {"at", rfc3339(event.at_ms)},
                    {"attempt", event.attempt}});
}

std::string to_json(const ProgressEvent& event) {
    return text_of({{"stage", event.stage}, {"percent", event.percent}});
}

std::vector<std::string> log_events(std::string_view metrics) {
    const Json result = Json::parse(metrics);
    std::vector<std::string> events;
    for (const auto& [list, level] :
         {std::pair("repairs", "info"), std::pair("warnings", "warning")}) {
        for (const Json& remark : result.at(list)) {
            Json event{{"level", level}};
            event.update(remark);
            events.push_back(text_of(event));
        }
    }
    return events;
}

std::string log_event(const Problem& problem) {
    return text_of({{"level", "error"}, {"code", problem.code.word()}, {"detail", problem.detail}});
}

}  // namespace lastflat::api
