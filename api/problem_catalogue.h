// Every error that the service and the program know: its code and its HTTP status, once.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace lastflat::api {

struct CataloguedProblem {
    std::string_view code;  ///< stable, for programs
    int status;
    int status_in_content = status;  ///< where what is at fault stands in the content, not the path
};

/// As `openapi.json` documents them (ProblemCode).
inline constexpr CataloguedProblem problem_catalogue[] = {
    // Of the constraints and the way they are sent
    {"invalid_request", 422},
    {"unsupported_request", 422},
    {"model_missing", 422},
    {"part_unknown", 400},
    {"part_repeated", 400},
    {"header_invalid", 400},
    // Of the model
    {"unreadable_model", 422},
    {"unsupported_model", 415},
    {"model_too_large", 413},
    {"mesh_not_manifold", 422},
    {"mesh_not_oriented", 422},
    {"mesh_degenerate", 422},
    {"group_not_found", 422},
    {"out_of_memory", 413},
    // Of the flattening
    {"curve_invalid", 422},
    {"region_invalid", 422},
    {"region_not_disk", 422},
    {"method_failed", 422},
    {"constraints_infeasible", 422},
    {"distortion_extreme", 422},
    {"border_crosses", 422},
    {"solver_failed", 500},
    // Of jobs and results
    {"job_not_found", 404},
    {"not_finished", 409},
    {"already_finished", 409},
    {"canceled", 409},
    {"result_expired", 410},
    {"format_unknown", 400},
    {"not_acceptable", 406},
    {"queue_full", 503},
    // Of live sessions
    {"session_not_found", 404},
    {"session_lost", 410},
    {"superseded", 409},
    {"sessions_full", 503},
    {"key_sessions_full", 429},
    // Of keys, storage and limits
    {"key_missing", 401},
    {"key_unknown", 401},
    {"token_invalid", 401},
    {"scope_refused", 403},
    {"no_keys", 401},
    {"host_refused", 403},
    {"origin_refused", 403},
    {"rate_exceeded", 429},
    {"key_queue_full", 429},
    {"key_in_flight", 409},
    {"key_reused", 422},
    {"id_taken", 409},
    {"asset_not_found", 404, 422},
    {"batch_not_found", 404},
    {"archive_too_large", 413},
    {"model_repeated", 400},
    {"buffer_missing", 422},
    {"part_unused", 400},
    {"digest_differs", 400},
    {"cursor_invalid", 400},
    {"parameter_invalid", 400},
    {"parameter_unknown", 400},
    {"media_type_unsupported", 415},
    {"storage_full", 507},
    {"assets_full", 507},
    {"quota_exceeded", 507},
    {"too_many_messages", 429},
    {"webhooks_off", 403},
    {"webhook_not_found", 404},
    {"too_many_webhooks", 422},
    {"range_outside", 416},
    {"job_expired", 410},
    {"streams_full", 503},
    {"validations_full", 503},
    {"draining", 503},
    {"store_unavailable", 503},
    {"result_corrupt", 500},
    {"model_lost", 500},
    {"worker_crashed", 500},
    {"worker_lost", 500},
    {"job_too_slow", 422},
    // Of HTTP itself
    {"bad_request_line", 400},
    {"bad_line_end", 400},
    {"bad_target", 400},
    {"bad_header", 400},
    {"repeated_header", 400},
    {"repeated_parameter", 400},
    {"id_malformed", 400},
    {"bad_host", 400},
    {"bad_content_length", 400},
    {"ambiguous_length", 400},
    {"multiple_ranges", 400},
    {"body_not_allowed", 400},
    {"body_cut_off", 400},
    {"bad_chunks", 400},
    {"bad_multipart", 400},
    {"too_many_parts", 400},
    {"not_found", 404},
    {"method_not_allowed", 405},
    {"head_too_slow", 408},
    {"body_too_slow", 408},
    {"body_too_large", 413},
    {"target_too_long", 414},
    {"content_encoding_not_supported", 415},
    {"expectation_not_supported", 417},
    {"too_many_headers", 431},
    {"head_too_large", 431},
    {"internal_error", 500},
    {"method_not_supported", 501},
    {"transfer_encoding_not_supported", 501},
    {"server_busy", 503},
    {"client_busy", 429},
    {"version_not_supported", 505},
    // Of the command line alone
    {"arguments_invalid", 400},
    {"file_unreadable", 404},
    {"file_unwritable", 500},
};

/// One line of the catalogue.
class ProblemCode {
public:
    /// A code that is not in the catalogue does not compile.
    consteval ProblemCode(const char* code) : line_(&line_of(code)) {}
    /// Throws: std::out_of_range if the catalogue does not have it.
    [[nodiscard]] static ProblemCode read(std::string_view code) {
        return ProblemCode(&line_of(code));
    }

    [[nodiscard]] constexpr std::string_view word() const { return line_->code; }
    [[nodiscard]] constexpr int status() const { return line_->status; }
    [[nodiscard]] constexpr int status_in_content() const { return line_->status_in_content; }
    /// The code in words.
    [[nodiscard]] std::string title() const {
        std::string title(word());
        for (char& c : title) {
            if (c == '_') c = ' ';
        }
        return title;
    }
    constexpr bool operator==(const ProblemCode&) const = default;

private:
    explicit constexpr ProblemCode(const CataloguedProblem* line) : line_(line) {}
    static constexpr const CataloguedProblem& line_of(std::string_view code) {
        for (const CataloguedProblem& line : problem_catalogue) {
            if (line.code == code) return line;
        }
        throw std::out_of_range("no problem has this code");
    }

    const CataloguedProblem* line_;
};

}  // namespace lastflat::api
