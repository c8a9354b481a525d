#include "server/routes/grant.h"

namespace lastflat::server {
namespace {

constexpr std::string_view jobs_path = "/v1/jobs", assets_path = "/v1/assets";

bool is_look(std::string_view method, std::string_view path) {
    return method == "GET" || method == "HEAD" || (method == "POST" && path.ends_with("/map"));
}

/// Of a path under a job's: its id; else empty.
std::string job_of(std::string_view path) {
    if (!path.starts_with("/v1/jobs/")) return {};
    path.remove_prefix(jobs_path.size() + 1);
    return std::string(path.substr(0, path.find('/')));
}

bool is_submission(std::string_view method, std::string_view path) {
    if (method == "PUT") return !job_of(path).empty();
    return method == "POST" && (path == jobs_path || path == "/v1/validate");
}

bool allows_asset(const std::string& id, std::string_view method, std::string_view path,
                  const ModelOfJob& model_of_job) {
    if (is_submission(method, path)) return true;
    const bool looks = is_look(method, path);
    if (looks && path == std::string(assets_path) + "/" + id) return true;
    const bool cancels = method == "POST" && path.ends_with("/cancel");
    const std::string job = job_of(path);
    return (looks || cancels) && !job.empty() && model_of_job(job) == id;
}

}  // namespace

Grant grant_of(KeyScope scope) {
    switch (scope) {
        case KeyScope::all: return {Grant::Kind::all};
        case KeyScope::jobs: return {Grant::Kind::jobs};
        case KeyScope::read: break;
    }
    return {Grant::Kind::read};
}

bool allows(const Grant& grant, std::string_view method, std::string_view path,
            const ModelOfJob& model_of_job) {
    const bool submits = is_submission(method, path) || (method == "POST" && path == assets_path);
    const bool looks = is_look(method, path) && !path.starts_with("/v1/webhooks");
    switch (grant.kind) {
        case Grant::Kind::all: return true;
        case Grant::Kind::jobs:
            return looks || submits || path.starts_with("/v1/sessions") ||
                   (method == "POST" && (path == "/v1/jobs:batch" || path.ends_with("/cancel")));
        case Grant::Kind::read: return looks;
        case Grant::Kind::submit: return submits;
        case Grant::Kind::job: return is_look(method, path) && job_of(path) == grant.id;
        case Grant::Kind::asset: return allows_asset(grant.id, method, path, model_of_job);
    }
    return false;
}

}  // namespace lastflat::server
