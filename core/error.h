// What core throws and what it warns of. One exception type; api/ turns it into a problem.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "core/numerics/types.h"

namespace lastflat {

enum class ErrorCode {
    unreadable_model,        ///< the bytes are not a well-formed file of their format
    unsupported_model,       ///< well-formed, but uses something that is not read
    model_too_large,         ///< a limit on size or counts is exceeded
    mesh_not_manifold,       ///< an edge or a vertex is shared in a way no surface can be
    mesh_not_oriented,       ///< neighbouring faces wind in opposite directions
    mesh_degenerate,         ///< a face without area, a coordinate that is not finite
    group_not_found,         ///< the request names a group that the model does not have
    curve_invalid,           ///< a curve is not a path on the surface
    region_invalid,          ///< a region cannot be told from the request
    region_not_disk,         ///< a region is not a disk
    method_failed,           ///< the method has no answer on this region (folded, singular)
    constraints_infeasible,  ///< the constraints cannot all hold
    distortion_extreme,      ///< what was found would be no pattern of a last
    border_crosses,          ///< the flat border crosses itself
    solver_failed,           ///< a linear system could not be solved
    unsupported_request,     ///< an option is out of its range
    canceled,                ///< the caller asked to stop
};

/// One of several constraints that cannot all hold.
struct ConflictMember {
    std::vector<std::string> option;  ///< where it stands in the options
    std::string title;
    double off_mm;  ///< at the best compromise
    Vec3 position;  ///< on the last
};

/// The one exception of core. `what()` says what was found, where, and what would mend it.
class Error : public std::runtime_error {
public:
    Error(ErrorCode code, const std::string& detail) : std::runtime_error(detail), code_(code) {}

    /// The part of the options that is at fault: {"curves", "heel", "vertices", "12"}.
    Error& at_option(std::vector<std::string> path) {
        option_ = std::move(path);
        return *this;
    }
    /// Where on the last, in mm.
    Error& at_position(const Vec3& position) {
        position_ = position;
        return *this;
    }

    /// The triangles at fault, by the file's vertex ids.
    Error& at_triangles(std::vector<Triangle> triangles) {
        triangles_ = std::move(triangles);
        return *this;
    }

    Error& with_conflict(std::vector<ConflictMember> conflict) {
        conflict_ = std::move(conflict);
        return *this;
    }

    [[nodiscard]] ErrorCode code() const { return code_; }
    [[nodiscard]] const std::optional<std::vector<std::string>>& option() const { return option_; }
    [[nodiscard]] const std::optional<Vec3>& position() const { return position_; }
    [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }
    /// The smallest set found of constraints that fight.
    [[nodiscard]] const std::vector<ConflictMember>& conflict() const { return conflict_; }

private:
    ErrorCode code_;
    std::optional<std::vector<std::string>> option_;
    std::optional<Vec3> position_;
    std::vector<Triangle> triangles_;
    std::vector<ConflictMember> conflict_;
};

/// Something the caller should know although the job succeeded.
struct Warning {
    std::string code;
    std::string detail;
    std::optional<Vec3> position;  ///< mm
};

/// "41.2 7.0 118.9": a position for a person to find, in mm to a tenth.
[[nodiscard]] std::string position_text(const Vec3& position);

}  // namespace lastflat
