#include "api/geometry_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>

#include "api/json.h"

namespace lastflat::api {
namespace {

// What grows with the mesh is written by hand: as JSON values it would take several times as long,
// which is a tenth of the time of a small job.

void append(std::string& text, double value) {
    if (!std::isfinite(value)) {
        text += "null";
        return;
    }
    std::array<char, 32> digits;
    text.append(digits.data(),
                std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

void append(std::string& text, Index value) {
    text += std::to_string(value);
}

template <int size>
void append(std::string& text, const Eigen::Matrix<double, size, 1>& point) {
    for (Eigen::Index i = 0; i < size; ++i) {
        text += i == 0 ? '[' : ',';
        append(text, point[i]);
    }
    text += ']';
}

void append(std::string& text, const Triangle& triangle) {
    for (std::size_t i = 0; i < 3; ++i) {
        text += i == 0 ? '[' : ',';
        append(text, triangle[i]);
    }
    text += ']';
}

void append(std::string& text, const OutlineLoop& loop);

template <class Item>
void append(std::string& text, const std::vector<Item>& list) {
    text += '[';
    for (const Item& item : list) {
        append(text, item);
        text += ',';
    }
    if (text.back() == ',') text.pop_back();
    text += ']';
}

void append(std::string& text, const OutlineLoop& loop) {
    Json segments = Json::array();
    for (const OutlineSegment& s : loop.segments)
        segments.push_back({{"curve", s.curve}, {"first", s.first}, {"last", s.last}});
    text += "{\"points_mm\":";
    append(text, loop.points);
    text += ",\"segments\":" + text_of(segments) + "}";
}

/// Numbers that may be missing.
void append_or_null(std::string& text, const std::vector<std::optional<Index>>& ids) {
    text += '[';
    for (const auto& id : ids) text += (id ? std::to_string(*id) : "null") + ",";
    if (text.back() == ',') text.pop_back();
    text += ']';
}

/// The way back to the model: ids of the file, and points between them for vertices that curves
/// made.
void append_sources(std::string& text, const Region& region, const SourceIds& sources) {
    std::vector<std::optional<Index>> vertices, triangles;
    std::string points;
    for (Index v = 0; at(v) < region.source_vertices.size(); ++v) {
        const Index id = region.source_vertices[at(v)];
        vertices.push_back(sources.file_vertex(id));
        if (vertices.back()) continue;
        const SurfacePoint made = sources.made_at(id);
        points += "{\"vertex\":" + std::to_string(v) + ",\"triangle\":";
        append(points, made.corners);
        points += ",\"weights\":";
        append(points, made.weights);
        points += "},";
    }
    for (const Index t : region.source_triangles)
        triangles.push_back(t < 0 ? std::nullopt : std::optional(t));
    if (!points.empty()) points.pop_back();
    text += ",\"source_vertices\":";
    append_or_null(text, vertices);
    text += ",\"source_points\":[" + points + "],\"source_triangles\":";
    append_or_null(text, triangles);
}

/// Calls with every vertex of every region that is one of the file: its id there, the region, the
/// vertex.
template <class Visit>
void for_each_file_vertex(const FlattenResult& result, const Visit& visit) {
    for (const FlatRegion& flat : result.regions) {
        for (Index v = 0; at(v) < flat.region.source_vertices.size(); ++v) {
            if (const auto id = result.sources.file_vertex(flat.region.source_vertices[at(v)]))
                visit(*id, flat.region, v);
        }
    }
}

/// Vertices of the file that lie at more than one place of the pattern.
Json seam_vertices(const FlattenResult& result) {
    std::vector<std::uint32_t> counts(result.sources.vertices, 0);
    for_each_file_vertex(result, [&](Index id, const Region&, Index) { ++counts[at(id)]; });
    std::map<Index, Json> places;
    for_each_file_vertex(result, [&](Index id, const Region& region, Index v) {
        if (counts[at(id)] > 1) places[id].push_back({{"region", region.name}, {"vertex", v}});
    });
    Json list = Json::array();
    for (auto& [vertex, found] : places)
        list.push_back({{"source_vertex", vertex}, {"places", std::move(found)}});
    return list;
}

}  // namespace

std::string mesh_text(const FlatRegion& flat, const SourceIds& sources) {
    std::string text = "\"triangles\":";
    append(text, flat.region.triangles);
    append_sources(text, flat.region, sources);
    return text;
}

std::string coordinates_text(const Points2& points) {
    std::string text;
    append(text, points);
    return text;
}

std::string coordinates_text(const Points3& points) {
    std::string text;
    append(text, points);
    return text;
}

std::string chart_text(const FlatRegion& flat) {
    return "\"uv_mm\":" + coordinates_text(flat.chart.uv);
}

std::string outline_text(const FlatRegion& flat) {
    std::string text = "\"outline\":";
    append(text, flat.outline);
    text += ",\"holes\":";
    append(text, flat.outline.holes);
    return text;
}

std::string model_text(const FlattenResult& result) {
    const SourceIds& sources = result.sources;
    std::string text = "\"model\":{\"vertices\":" + std::to_string(sources.vertices) +
                       ",\"triangles\":" + std::to_string(sources.triangles) + ",\"welded_to\":";
    const auto& weld = sources.welded_to;
    const bool any_welded =  // else they are 0, 1, 2 ...
        std::adjacent_find(weld.begin(), weld.end(), std::greater_equal<>()) != weld.end();
    append(text, any_welded ? weld : std::vector<Index>());
    return text + ",\"seam_vertices\":" + text_of(seam_vertices(result)) + "}";
}

}  // namespace lastflat::api
