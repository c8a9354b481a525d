// A job as the server keeps it.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "api/webhook.h"
#include "server/jobs/job_state.h"

namespace lastflat::server {

/// What the server knows a job by. An id is unique among the jobs of its owner alone.
using JobNumber = std::int64_t;

/// What a job asks for. The model is a blob; the request is the constraint JSON as it was sent.
struct NewJob {
    std::string id;
    std::string owner;  ///< id of the API key; empty: the service is open
    std::string tag;
    std::string batch;  ///< id of the batch it came in; empty: alone
    api::JobPriority priority = api::JobPriority::interactive;
    std::string model, request;
    std::uint64_t model_bytes = 0;
    std::string fingerprint;  ///< of everything asked: the same means a repetition
    /// Of all that its result depends on, the program included; empty: it is answered by its own
    /// run alone.
    std::string question;
    bool fresh = false;                        ///< it is run even if the question has an answer
    std::string idempotency_key;               ///< empty: none
    std::optional<std::int64_t> cancel_at_ms;  ///< if it has not ended by then
    std::optional<api::WebhookRequest> webhook;
};

/// Jobs that are taken together or not at all.
struct NewBatch {
    std::string id, owner;
    std::string fingerprint, idempotency_key;
    std::vector<NewJob> jobs;  ///< with this owner and batch
};

struct BatchRecord {
    std::string id, owner;
    std::int64_t created_ms = 0;
    std::optional<std::int64_t> finished_ms;  ///< when the last of its jobs ended
    std::size_t size = 0;                     ///< jobs that were taken
    std::map<JobState, std::size_t> states;   ///< of those that are left
    std::int64_t revision = 0;                ///< changes when one of them does
    std::optional<JobNumber> unfinished;      ///< the first of them that has not ended
};

/// One format of a result: a part of the result's blob.
struct ResultPart {
    std::string format;  ///< "json", "svg", "glb", "obj", "metrics"
    std::uint64_t offset = 0, size = 0;
    std::string digest;  ///< SHA-256 of the part
};

struct JobRecord {
    JobNumber number = 0;
    std::string id, owner, tag, batch;
    api::JobPriority priority = api::JobPriority::interactive;
    JobState state = JobState::queued;
    std::string reason;  ///< why it was canceled: "client", "deadline"
    std::string fingerprint, model;
    std::uint64_t model_bytes = 0;
    std::int64_t created_ms = 0;
    std::optional<std::int64_t> started_ms, finished_ms, cancel_at_ms;
    std::optional<std::int64_t> result_expires_ms, expires_ms;  ///< once it has ended
    int attempt = 0;                            ///< succeeded with 0: answered by an earlier result
    std::int64_t revision = 0;                  ///< grows with every change
    std::optional<std::size_t> queue_position;  ///< while queued; 1: next
    std::optional<api::Problem> error;          ///< of a failed job
    std::string result;                         ///< the blob; empty: none, or expired
    std::vector<ResultPart> parts;
};

/// How a run ends that was not canceled.
struct Succeeded {
    std::string result;  ///< the blob
    std::vector<ResultPart> parts;
};
struct Failed {
    api::Problem problem;
};
using JobEnd = std::variant<Succeeded, Failed>;

/// 26 characters that sort by time and cannot be guessed (a ULID).
[[nodiscard]] std::string new_job_id();

}  // namespace lastflat::server
