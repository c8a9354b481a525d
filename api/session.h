// A live session, as it stands on the wire.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lastflat {
class Session;
enum class Reach;
}  // namespace lastflat

namespace lastflat::api {

struct SessionView {
    std::string id;
    std::int64_t created_ms = 0;
    std::int64_t expires_ms = 0;  ///< if nothing is asked until then
};

/// `state`: of `session_json`, its members beside those of the session.
[[nodiscard]] std::string to_json(const SessionView& session, const std::string& state);
[[nodiscard]] std::string to_json(const std::vector<SessionView>& sessions);

/// Where a session stands.
struct SessionStep {
    std::uint64_t revision = 0;  ///< grows with every change that took effect
    std::uint64_t sequence = 0;  ///< of the last of them; 0: none
    Reach changed{};             ///< how far that reached
};

/// {"revision", "sequence", "changed", "curves", "pattern"}: the pattern as in a result, without
/// what stays while the regions do, and none where it has not changed. `request`: JSON, a member
/// more; empty: without it.
[[nodiscard]] std::string session_json(const Session& session, const SessionStep& step,
                                       const std::string& version, const std::string& request = "");

/// The same for machines that draw, `application/vnd.lastflat.points`: in 32 bit, little endian,
/// numbers unsigned, coordinates float.
///
///   "LFPT", 1 (of this layout), revision, changed (0 nothing, 1 curves, 2 pattern, 3 regions or
///   model), number of regions, number of curves;
///   for every region: number of vertices (0: they have not moved), u and v of each, mm;
///   for every curve: number of points on the last, x, y and z of each, mm; number of runs; for
///   each of them: its region's place in the list, number of points, u and v of each, mm.
[[nodiscard]] std::string session_points(const Session& session, const SessionStep& step);

inline constexpr std::string_view points_media_type = "application/vnd.lastflat.points";

struct Job;

/// {"job", "difference_mm"}. `comparison`: {"difference_mm"}, as the session says it.
[[nodiscard]] std::string session_job_json(const Job& job, const std::string& comparison);

/// The request after a change: a JSON merge patch (RFC 7396), lists replaced whole.
/// Throws: InvalidRequest if the patch is no object, or the request no good after it.
[[nodiscard]] std::string merged_request(const std::string& request, std::string_view patch);

}  // namespace lastflat::api
