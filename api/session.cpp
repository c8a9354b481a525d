#include "api/session.h"

#include <algorithm>
#include <bit>

#include "api/flatten_request.h"
#include "api/flatten_result.h"
#include "api/geometry_text.h"
#include "api/job.h"
#include "api/json.h"
#include "api/object_reader.h"
#include "api/timestamp.h"
#include "api/words.h"
#include "core/session/session.h"

namespace lastflat::api {
namespace {

constexpr Word<Reach> reach_words[]{{"nothing", Reach::nothing},
                                    {"curves", Reach::curves},
                                    {"pattern", Reach::pattern},
                                    {"regions", Reach::regions},
                                    {"model", Reach::model}};

Json view_json(const SessionView& session) {
    return {{"id", session.id},
            {"created_at", rfc3339(session.created_ms)},
            {"expires_at", rfc3339(session.expires_ms)},
            {"durable", false}};
}

std::string curve_text(const ShownCurve& curve) {
    std::string text = text_of(Json{{"name", curve.name},
                                    {"length_3d_mm", curve.length_3d},
                                    {"length_2d_mm", curve.length_2d}});
    text.pop_back();
    text += ",\"points\":" + coordinates_text(curve.on_last) + ",\"runs\":[";
    for (const ShownRun& run : curve.runs) {
        if (text.back() == '}') text += ',';
        text += "{\"region\":" + text_of(Json(run.region)) +
                ",\"uv_mm\":" + coordinates_text(run.uv) + "}";
    }
    return text + "]}";
}

/// Puts numbers behind each other, little endian.
class Words32 {
public:
    void add(std::size_t number) { add_bits(static_cast<std::uint32_t>(number)); }
    void add(double value) { add_bits(std::bit_cast<std::uint32_t>(static_cast<float>(value))); }
    template <class Points>
    void add_points(const Points& points) {
        add(points.size());
        for (const auto& point : points) {
            for (const double value : point) add(value);
        }
    }
    std::string bytes = "LFPT";

private:
    void add_bits(std::uint32_t bits) {
        for (int shift = 0; shift < 32; shift += 8)
            bytes += static_cast<char>(static_cast<unsigned char>(bits >> shift));
    }
};

std::size_t place_of(const FlattenResult& pattern, const std::string& region) {
    std::size_t place = 0;
    while (pattern.regions[place].region.name != region) ++place;
    return place;
}

}  // namespace

std::string to_json(const SessionView& session, const std::string& state) {
    std::string text = text_of(view_json(session));
    text.back() = ',';
    return text + state.substr(1);
}

std::string to_json(const std::vector<SessionView>& sessions) {
    Json items = Json::array();
    for (const SessionView& session : sessions) items.push_back(view_json(session));
    return text_of(Json{{"items", std::move(items)}});
}

std::string session_json(const Session& session, const SessionStep& step,
                         const std::string& version, const std::string& request) {
    std::string text = "{\"revision\":" + std::to_string(step.revision) +
                       ",\"sequence\":" + std::to_string(step.sequence) + ",\"changed\":\"" +
                       std::string(word_of(reach_words, step.changed)) + "\",\"curves\":[";
    for (const ShownCurve& curve : session.curves()) {
        if (text.back() == '}') text += ',';
        text += curve_text(curve);
    }
    text += ']';
    if (step.changed == Reach::pattern)
        text += ",\"pattern\":" + moved_json(session.pattern(), version);
    if (step.changed > Reach::pattern)
        text += ",\"pattern\":" + to_json(session.pattern(), version);
    if (!request.empty()) text += ",\"request\":" + request;
    return text + '}';
}

std::string session_points(const Session& session, const SessionStep& step) {
    constexpr std::size_t layout = 1;
    const FlattenResult& pattern = session.pattern();
    Words32 words;
    words.add(layout);
    words.add(step.revision);
    words.add(static_cast<std::size_t>(std::min(step.changed, Reach::regions)));
    words.add(pattern.regions.size());
    words.add(session.curves().size());
    for (const FlatRegion& flat : pattern.regions)
        words.add_points(step.changed >= Reach::pattern ? flat.chart.uv : Points2());
    for (const ShownCurve& curve : session.curves()) {
        words.add_points(curve.on_last);
        words.add(curve.runs.size());
        for (const ShownRun& run : curve.runs) {
            words.add(place_of(pattern, run.region));
            words.add_points(run.uv);
        }
    }
    return std::move(words.bytes);
}

std::string session_job_json(const Job& job, const std::string& comparison) {
    return "{\"job\":" + to_json(job) + "," + comparison.substr(1);
}

std::string merged_request(const std::string& request, std::string_view patch) {
    const RequestLimits limits;
    if (patch.size() > limits.bytes)
        throw InvalidRequest("",
                             "the patch has more than " + std::to_string(limits.bytes) + " bytes");
    const nlohmann::json change = parse_json(patch, limits.depth);
    if (!change.is_object()) throw InvalidRequest("", "the patch must be an object");
    nlohmann::json merged = request.find_first_not_of(" \t\r\n") == std::string::npos
                                ? nlohmann::json::object()
                                : nlohmann::json::parse(request);
    merged.merge_patch(change);
    std::string text = merged.dump(-1, ' ', true);
    (void)flatten_request_from_json(text, limits);
    return text;
}

}  // namespace lastflat::api
