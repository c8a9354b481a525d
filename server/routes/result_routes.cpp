#include "server/routes/result_routes.h"

#include <charconv>

#include "api/base64.h"
#include "api/refusal.h"
#include "server/jobs/job_control.h"
#include "server/jobs/result_parts.h"
#include "server/routes/answers.h"
#include "server/routes/result_format.h"
#include "server/support/gzip.h"

namespace lastflat::server {
namespace {

using http::Request;
using http::Response;

JobRecord finished_job(const ResultServices& service, const Request& request) {
    JobRecord job = found_job(service.jobs, request.principal, request.captures.at(0));
    switch (job.state) {
        case JobState::succeeded: break;
        case JobState::failed: throw api::Refusal(api::without_result(job.error.value()));
        case JobState::canceled: api::refuse("canceled", "the job was canceled; it has no result");
        case JobState::queued:
        case JobState::running:
        case JobState::canceling:
            api::refuse("not_finished",
                        "the job is " + std::string(name(job.state)) + "; ask again later");
    }
    if (job.result.empty())
        api::refuse("result_expired", "the result was kept as long as results are; it is gone");
    return job;
}

/// A range of the plain bytes, if one was asked for and the client's copy is of this result.
void cut_to_range(const Request& request, const std::string& etag, Response& response) {
    const std::string_view condition = request.header("if-range");
    if (!condition.empty() && condition != etag) return;
    const std::uint64_t size = response.body->size();
    const auto range = wanted_range(request, size);
    if (!range) return;
    response.status = 206;
    response.headers.emplace_back("Content-Range", "bytes " + std::to_string(range->first) + "-" +
                                                       std::to_string(range->last) + "/" +
                                                       std::to_string(size));
    response.body = std::make_shared<const std::string>(
        response.body->substr(range->first, range->last - range->first + 1));
}

Response part_response(const ResultServices& service, const Request& request, const JobRecord& job,
                       std::string_view format, const std::string& type,
                       const std::string& file_name) {
    const bool packed = accepts_gzip(request) && request.header("range").empty();
    const ResultPart& part = result_part(job, format);
    const std::string etag = "\"" + part.digest.substr(0, 32) + (packed ? "-gzip\"" : "\"");
    Response response;
    response.media_type = type;
    response.headers.emplace_back("Vary", "Accept, Accept-Encoding");
    response.headers.emplace_back("Cache-Control", "private, no-cache");
    response.headers.emplace_back("Accept-Ranges", "bytes");
    if (packed) response.headers.emplace_back("Content-Encoding", "gzip");
    response.headers.emplace_back("Content-Disposition", "inline; filename=\"" + file_name + "\"");
    if (has_already(request, etag)) return tagged(request, etag, std::move(response));
    std::string bytes = result_bytes(service.blobs, job, part);
    if (packed) bytes = gzip(bytes);
    response.body = std::make_shared<const std::string>(std::move(bytes));
    if (!packed) cut_to_range(request, etag, response);
    response.headers.emplace_back("ETag", etag);
    return response;
}

Response result_as(const ResultServices& service, const Request& request, ResultFormat format) {
    const JobRecord job = finished_job(service, request);
    const std::string_view word = word_of(api::result_formats, format);
    return part_response(service, request, job, word,
                         std::string(word_of(api::result_media_types, format)),
                         job.id + "." + std::string(word));
}

Response map_points(const ResultServices& service, const Request& request) {
    const JobRecord job = finished_job(service, request);
    if (request.body.size() != 1 || request.body[0].media_type != "application/json")
        api::refuse("media_type_unsupported", "what is to be mapped is JSON: application/json");
    const ResultPart& obj = result_part(job, "obj");
    const WaitingSeat seat(service.seats, request);
    if (!seat.is_taken())
        api::refuse("validations_full",
                    "too many models and patterns are being looked at; try again later");
    return json_response(200, service.maps.map(
                                  obj.digest, [&] { return result_bytes(service.blobs, job, obj); },
                                  std::string(request.body[0].bytes)));
}

int wanted_width(const Request& request) {
    constexpr int usual = 640, least = 16, most = 2048;
    const auto given = request.query.find("width");
    if (given == request.query.end()) return usual;
    const std::string& text = given->second;
    int width = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), width);
    const bool whole = read.ec == std::errc() && read.ptr == text.data() + text.size();
    if (!whole || width < least || width > most)
        api::refuse("parameter_invalid", "width is a number of pixels from " +
                                             std::to_string(least) + " to " + std::to_string(most));
    return width;
}

/// The drawing as a picture, made when it is asked for.
Response picture(const ResultServices& service, const Request& request) {
    const JobRecord job = finished_job(service, request);
    const std::string width = std::to_string(wanted_width(request));
    const ResultPart& svg = result_part(job, "svg");
    const std::string etag = "\"" + svg.digest.substr(0, 32) + "-" + width + "\"";
    Response response;
    response.media_type = "image/png";
    response.headers.emplace_back("Cache-Control", "private, no-cache");
    response.headers.emplace_back("Content-Disposition", "inline; filename=\"" + job.id + ".png\"");
    if (has_already(request, etag)) return tagged(request, etag, std::move(response));
    const std::string drawing = result_bytes(service.blobs, job, svg);
    const auto png =
        api::decode_base64(service.tasks.report(request, Task::thumbnail, drawing, width));
    response.body = std::make_shared<const std::string>(png.value());
    response.headers.emplace_back("ETag", etag);
    return response;
}

}  // namespace

std::vector<http::Route> result_routes(const ResultServices& service) {
    std::vector<http::Route> routes{
        {"GET",
         "/v1/jobs/{id}/result",
         [service](const Request& request) {
             return result_as(service, request, negotiated_format(request));
         },
         false,
         false,
         {"format", "token"}},
        {"GET",
         "/v1/jobs/{id}/metrics",
         [service](const Request& request) {
             const JobRecord job = finished_job(service, request);
             return part_response(service, request, job, "metrics", "application/json",
                                  job.id + ".metrics.json");
         },
         false,
         false,
         {"token"}},
        {"GET",
         "/v1/jobs/{id}/result.png",
         [service](const Request& request) { return picture(service, request); },
         false,
         false,
         {"token", "width"}},
        {"POST", "/v1/jobs/{id}/map",
         [service](const Request& request) { return map_points(service, request); }, true}};
    for (const auto& [word, format] : api::result_formats) {
        routes.push_back({"GET",
                          "/v1/jobs/{id}/result." + std::string(word),
                          [service, format = format](const Request& request) {
                              return result_as(service, request, format);
                          },
                          false,
                          false,
                          {"token"}});
    }
    return routes;
}

}  // namespace lastflat::server
