#include "server/routes/batch_results.h"

#include "api/batch_table.h"
#include "api/refusal.h"
#include "api/result_format.h"
#include "server/jobs/result_parts.h"
#include "server/support/gzip.h"
#include "server/support/log.h"
#include "server/support/zip.h"

namespace lastflat::server {
namespace {

using http::Request;
using http::Response;

BatchRecord finished_batch(const BatchView& view, const Request& request) {
    BatchRecord batch = view.found(request, request.captures.at(0));
    if (batch.finished_ms) return batch;
    api::refuse("not_finished", "not all jobs of the batch have ended; ask again later");
}

/// Why the job has no result; nothing: it has one.
std::optional<api::Problem> problem_of(const JobRecord& job) {
    if (job.error) return job.error;
    if (job.state != JobState::succeeded)
        return api::Problem("canceled", "the job was canceled; it has no result");
    if (job.result.empty())
        return api::Problem("result_expired",
                            "the result was kept as long as results are; it is gone");
    return std::nullopt;
}

/// `use(part)` for a job that has a result, unless its bytes have changed: a client gets the
/// others.
template <class Use>
void with_result(const BatchView& view, const JobRecord& job, api::BatchErrors& errors, Use use) {
    auto problem = problem_of(job);
    try {
        if (!problem) return use();
    } catch (const CorruptBlob& corrupt) {
        log_event("request_refused", {{"job", job.id}, {"why", corrupt.what()}});
        problem = corrupt.problem();
    }
    errors.add(view.of(job), *problem);
}

std::string table_of(const BatchResultServices& service, const std::vector<JobRecord>& jobs) {
    api::BatchTable table;
    api::BatchErrors errors;
    for (const JobRecord& job : jobs) {
        std::string metrics;
        with_result(service.view, job, errors, [&] {
            metrics = result_bytes(service.blobs, job, result_part(job, "metrics"));
        });
        table.add(service.view.of(job), metrics);
    }
    return table.text();
}

Response table(const BatchResultServices& service, const Request& request) {
    const BatchRecord batch = finished_batch(service.view, request);
    Response response;
    response.media_type = "text/csv; charset=utf-8";
    response.headers.emplace_back("Cache-Control", "no-store");
    response.headers.emplace_back("Content-Disposition",
                                  "attachment; filename=\"" + batch.id + ".csv\"");
    response.body =
        std::make_shared<const std::string>(table_of(service, service.view.jobs_of(batch)));
    return response;
}

/// "007-order-4711": a name on every file system, in the order of the batch.
std::string folder_of(std::size_t index, const JobRecord& job) {
    constexpr std::size_t longest = 60;
    std::string number = std::to_string(index);
    std::string name = std::string(3 - std::min<std::size_t>(3, number.size()), '0') + number + "-";
    for (const char c : (job.tag.empty() ? job.id : job.tag).substr(0, longest)) {
        const bool is_plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') ||
                              (c >= 'a' && c <= 'z') || c == '-' || c == '_' || c == '.';
        name += is_plain ? c : '_';
    }
    return name;
}

/// The archive as it is sent, job by job: it is never in memory as a whole.
class Archive {
public:
    Archive(const BatchResultServices& service, std::vector<JobRecord> jobs)
        : service_(service), jobs_(std::move(jobs)) {}

    /// Sends the next job's files. False: it is complete, or the client is gone.
    bool step(const http::Write& write) {
        if (next_ < jobs_.size()) {
            const std::size_t index = next_++;
            std::string files;
            with_result(service_.view, jobs_[index], errors_,
                        [&] { files = files_of(index, jobs_[index]); });
            return files.empty() || write(files);
        }
        std::string rest = zip_.entry("results.csv", gzip(table_of(service_, jobs_)));
        rest += zip_.entry("errors.json", gzip(errors_.json()));
        write(rest + zip_.end());
        return false;
    }

private:
    std::string files_of(std::size_t index, const JobRecord& job) {
        const std::string folder = folder_of(index + 1, job) + "/";
        std::vector<std::pair<std::string, std::string>> parts;
        for (const auto& [word, format] : api::result_formats) {
            parts.emplace_back(folder + std::string(word_of(api::result_file_names, format)),
                               result_bytes(service_.blobs, job, result_part(job, word)));
        }
        std::string files;
        for (const auto& [name, bytes] : parts) files += zip_.entry(name, gzip(bytes));
        return files;
    }

    const BatchResultServices service_;
    const std::vector<JobRecord> jobs_;
    std::size_t next_ = 0;
    Zip zip_;
    api::BatchErrors errors_;
};

Response archive(const BatchResultServices& service, const Request& request) {
    const BatchRecord batch = finished_batch(service.view, request);
    std::vector<JobRecord> jobs = service.view.jobs_of(batch);
    std::uint64_t bytes = 0;
    for (const JobRecord& job : jobs) bytes += size_of(job.parts);
    if (bytes > Zip::most_bytes)
        api::refuse("archive_too_large",
                    "the results together have more than 4 GiB; fetch them job by job");
    Response response;
    response.media_type = "application/zip";
    response.headers.emplace_back("Cache-Control", "no-store");
    response.headers.emplace_back("Content-Disposition",
                                  "attachment; filename=\"" + batch.id + ".zip\"");
    const auto files = std::make_shared<Archive>(service, std::move(jobs));
    response.stream = [files](const http::Write& write) { return files->step(write); };
    return response;
}

}  // namespace

std::vector<http::Route> batch_result_routes(const BatchResultServices& service) {
    return {{"GET", "/v1/batches/{id}/results.csv",
             [service](const Request& request) { return table(service, request); }},
            {"GET", "/v1/batches/{id}/result.zip",
             [service](const Request& request) { return archive(service, request); }}};
}

}  // namespace lastflat::server
