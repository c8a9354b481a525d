// A job sent as JSON alone: the model in base64, or an asset, beside the constraints.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "api/flatten_request.h"
#include "api/webhook.h"

namespace lastflat::api {

struct Field;

struct JsonSubmission {
    std::string model;     ///< decoded; empty if `asset_id` is given
    std::string asset_id;  ///< of a model that was sent before
    FlattenRequest request;
    std::string request_text;  ///< its JSON; empty if absent
    std::optional<JobPriority> priority;
    std::optional<WebhookRequest> webhook;
};

/// Reads {"model": {"data": base64} or {"asset_id": id}, "request": {...}, "webhook": {...},
/// "priority": ...}.
/// Throws: InvalidRequest naming the field.
[[nodiscard]] JsonSubmission read_json_submission(const Field& field,
                                                  const RequestLimits& limits = {});
/// The same from a document.
[[nodiscard]] JsonSubmission json_submission_from_json(std::string_view text,
                                                       const RequestLimits& limits = {});

/// What the first bytes show to be no model is refused before a job is made.
/// Throws: Error (`unsupported_model`, `unreadable_model`).
void check_model_bytes(std::string_view model);

}  // namespace lastflat::api
