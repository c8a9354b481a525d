// The three ways to send a job, read into one.
#pragma once

#include <string_view>

#include "api/submission.h"
#include "server/http/http.h"
#include "server/jobs/job_intake.h"

namespace lastflat::server {

/// What a key or token of a smaller scope may not name: another asset than its own, a webhook.
/// Throws: api::Refusal (403).
void check_scope(const http::Request& request, const Submission& submission);

/// multipart/form-data with the parts `model` (and the `buffers` of a glTF, the `mtl` of an OBJ) or
/// `asset_id` and, optional, `request`;
/// application/json with the model in base64 or an asset's id; or the model's bytes alone, its
/// constraints in the header `X-Flatten-Constraints` (base64url) or absent. Lasts as long as the
/// request's body.
/// Throws: api::Refusal, api::InvalidRequest.
[[nodiscard]] Submission read_submission(const http::Request& request);

/// The same with the model's bytes, an asset's too. Throws also StoreError.
[[nodiscard]] Submission read_submission_with_model(const http::Request& request,
                                                    AssetStore& assets, const BlobStore& blobs);

/// `pointer`: where in the body it stands. Throws as above.
[[nodiscard]] Submission submission_of(api::JsonSubmission json, const std::string& pointer = "");

/// Who sends it, and what the headers Idempotency-Key, Cancel-After and Job-Priority say of it.
/// Throws: api::Refusal (400).
void read_terms(const http::Request& request, Submission& submission);

}  // namespace lastflat::server
