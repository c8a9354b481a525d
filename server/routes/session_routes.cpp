#include "server/routes/session_routes.h"

#include <fcntl.h>

#include <charconv>

#include "api/flatten_request.h"
#include "api/job.h"
#include "api/object_reader.h"
#include "api/refusal.h"
#include "api/session.h"
#include "server/routes/answers.h"
#include "server/routes/submission.h"
#include "server/support/files.h"

namespace lastflat::server {
namespace {

using http::Request;
using http::Response;

SessionEntry session_of(const SessionServices& service, const Request& request) {
    return service.sessions.find(request.principal, request.captures.at(0));
}

api::SessionView view_of(const SessionServices& service, const SessionEntry& entry) {
    return {entry.id, entry.created_ms, service.sessions.expires_ms(entry)};
}

bool wants_points(const Request& request) {
    return request.header("accept").find(api::points_media_type) != std::string_view::npos;
}

Response bytes_response(std::string_view media_type, std::string body) {
    Response response;
    response.media_type = media_type;
    response.body = std::make_shared<const std::string>(std::move(body));
    response.headers.emplace_back("Cache-Control", "no-store");
    return response;
}

/// Opening takes as long as a job; the seat is for that.
Response open(const SessionServices& service, const Request& request) {
    Submission submission = read_submission_with_model(request, service.assets, service.blobs);
    if (submission.webhook) throw api::InvalidRequest("/webhook", "a session sends no messages");
    check_room(service.blobs, service.min_free_mb);
    const WaitingSeat seat(service.seats, request);
    if (!seat.is_taken()) api::refuse("streams_full", "too many requests wait; try again later");
    const auto [entry, state] = service.sessions.open(request.principal, Task::session,
                                                      submission.model, submission.request);
    Response response = json_response(201, api::to_json(view_of(service, entry), state));
    response.headers.emplace_back("Location", "/v1/sessions/" + entry.id);
    return response;
}

Response list(const SessionServices& service, const Request& request) {
    std::vector<api::SessionView> views;
    for (const SessionEntry& entry : service.sessions.list(request.principal))
        views.push_back(view_of(service, entry));
    return json_response(200, api::to_json(views));
}

Response look(const SessionServices& service, const Request& request) {
    const SessionEntry entry = session_of(service, request);
    const bool points = wants_points(request);
    std::string state = entry.live->ask({0, AskKind::state, 0, points});
    if (points) return bytes_response(api::points_media_type, std::move(state));
    return json_response(200, api::to_json(view_of(service, entry), state));
}

std::uint64_t sequence_of(const Request& request) {
    const auto given = request.query.find("sequence");
    const std::string text = given == request.query.end() ? "" : given->second;
    std::uint64_t sequence = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), sequence);
    if (read.ec != std::errc() || read.ptr != text.data() + text.size() || sequence == 0)
        api::refuse("parameter_invalid",
                    "a change needs ?sequence=N, a whole number above that of the change before");
    return sequence;
}

std::string_view json_of(const Request& request, std::string_view other_type = "application/json") {
    if (request.body.size() != 1 || (request.body[0].media_type != "application/json" &&
                                     request.body[0].media_type != other_type))
        api::refuse("media_type_unsupported",
                    "what is asked here is JSON: " + std::string(other_type));
    return request.body[0].bytes;
}

Response change(const SessionServices& service, const Request& request) {
    const bool points = wants_points(request);
    const std::string_view patch = json_of(request, "application/merge-patch+json");
    SessionAsk ask{0, AskKind::change, sequence_of(request), points, std::string(patch)};
    std::string changed = session_of(service, request).live->ask(std::move(ask));
    if (points) return bytes_response(api::points_media_type, std::move(changed));
    return json_response(200, std::move(changed));
}

Response close(const SessionServices& service, const Request& request) {
    service.sessions.close(request.principal, request.captures.at(0));
    return empty_response(204);
}

Response surface(const SessionServices& service, const Request& request) {
    return bytes_response("model/gltf-binary",
                          session_of(service, request).live->ask({0, AskKind::surface}));
}

Response map_points(const SessionServices& service, const Request& request) {
    SessionAsk ask{0, AskKind::map, 0, false, std::string(json_of(request))};
    return json_response(200, session_of(service, request).live->ask(std::move(ask)));
}

/// Nothing to compare with if a fresh start comes to no pattern.
std::string comparison_of(LiveSession& live) {
    try {
        return live.ask({0, AskKind::compare});
    } catch (const api::Refusal&) {
        return R"({"difference_mm":null})";
    }
}

/// What is asked now, as a job of its own; and how far that will be from what is shown.
Response make_job(const SessionServices& service, const Request& request) {
    const SessionEntry entry = session_of(service, request);
    Submission submission;
    const File model(entry.model, O_RDONLY);
    submission.make_model(model.read(0, model.size()));
    submission.request = entry.live->ask({0, AskKind::request});
    submission.owner = request.principal;
    submission.tag = api::flatten_request_from_json(submission.request).tag;
    const JobRecord job = service.intake.submit(submission).job;
    Response response =
        json_response(202, api::session_job_json(service.view.of(job), comparison_of(*entry.live)));
    response.headers.emplace_back("Location", "/v1/jobs/" + job.id);
    return response;
}

http::Route route(const SessionServices& service, const char* method, const char* under,
                  Response (*answer)(const SessionServices&, const Request&),
                  bool takes_body = false, std::vector<std::string> parameters = {}) {
    return {method,
            std::string("/v1/sessions") + under,
            [service, answer](const Request& request) { return answer(service, request); },
            takes_body,
            false,
            std::move(parameters)};
}

}  // namespace

std::vector<http::Route> session_routes(const SessionServices& service) {
    return {route(service, "POST", "", open, true, {"asset_id"}),
            route(service, "GET", "", list),
            route(service, "GET", "/{id}", look),
            route(service, "PATCH", "/{id}", change, true, {"sequence"}),
            route(service, "DELETE", "/{id}", close),
            route(service, "GET", "/{id}/surface", surface),
            route(service, "POST", "/{id}/map", map_points, true),
            route(service, "POST", "/{id}/job", make_job)};
}

}  // namespace lastflat::server
