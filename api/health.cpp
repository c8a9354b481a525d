#include "api/health.h"

#include "api/json.h"

namespace lastflat::api {

std::string to_json(const Health& health) {
    Json json{{"status", word_of(statuses, health.status)}};
    if (!health.version.empty()) json["version"] = health.version;
    if (health.jobs)
        json["jobs"] = {{"queued", health.jobs->queued}, {"running", health.jobs->running}};
    return text_of(json);
}

std::string version_json(const std::string& version) {
    return text_of({{"version", version}});
}

}  // namespace lastflat::api
