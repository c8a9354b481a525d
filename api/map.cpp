#include "api/map.h"

#include "api/flatten_request.h"
#include "api/json.h"
#include "api/object_reader.h"

namespace lastflat::api {
namespace {

constexpr int deepest_map = 8;

template <class Point>
Point read_point(const Field& field, std::size_t& left) {
    constexpr auto dimensions = static_cast<std::size_t>(Point::RowsAtCompileTime);
    if (left-- == 0)
        field.fail("more than " + std::to_string(most_mapped_points) + " points in one request");
    const auto items = field.items(dimensions);
    if (items.size() != dimensions)
        field.fail("must be " + std::to_string(dimensions) + " numbers");
    Point point;
    for (std::size_t i = 0; i < dimensions; ++i)
        point[static_cast<Eigen::Index>(i)] = items[i].number(-far_away, far_away);
    return point;
}

template <class Point>
Drawing<Point> read_drawing(const Field& field, std::size_t& left) {
    ObjectReader reader(field);
    Drawing<Point> drawing;
    if (const auto region = reader.find("region"))
        drawing.region = region->text(RequestLimits().name_bytes);
    if (const auto points = reader.find("points")) {
        for (const Field& item : points->items(most_mapped_points))
            drawing.points.push_back(read_point<Point>(item, left));
    }
    if (const auto polylines = reader.find("polylines")) {
        for (const Field& line : polylines->items(most_mapped_points)) {
            drawing.polylines.emplace_back();
            for (const Field& item : line.items(most_mapped_points))
                drawing.polylines.back().push_back(read_point<Point>(item, left));
            if (drawing.polylines.back().size() < 2) line.fail("must have at least two points");
        }
    }
    reader.finish();
    return drawing;
}

}  // namespace

MapRequest map_request_from_json(std::string_view text) {
    const auto json = parse_json(text, deepest_map);
    ObjectReader reader({json, ""});
    MapRequest request;
    std::size_t left = most_mapped_points;
    if (const auto drawing = reader.find("to_pattern"))
        request.to_pattern = read_drawing<Vec3>(*drawing, left);
    if (const auto drawing = reader.find("to_last")) {
        request.to_last = read_drawing<Vec2>(*drawing, left);
        if (request.to_last->region.empty())
            drawing->fail("must name the \"region\" that its points lie on");
    }
    reader.finish();
    if (!request.to_pattern && !request.to_last)
        reader.field().fail("must have \"to_pattern\" or \"to_last\"");
    return request;
}

static Json json_of(const PointOnPattern& p) {
    return {{"region", p.region}, {"uv_mm", json_of(p.uv_mm)}, {"distance_mm", p.distance_mm}};
}
static Json json_of(const RunOnPattern& r) {
    return {{"region", r.region}, {"uv_mm", json_of(r.uv_mm)}, {"distance_mm", r.distance_mm}};
}
static Json json_of(const PointOnLast& p) {
    return {{"position", json_of(p.position)}, {"distance_mm", p.distance_mm}};
}
static Json json_of(const LineOnLast& l) {
    return {{"positions", json_of(l.positions)}, {"distance_mm", l.distance_mm}};
}
template <class Drawn>
static Json drawn_json(const Drawn& drawn) {
    return {{"points", json_of(drawn.points)}, {"polylines", json_of(drawn.polylines)}};
}

std::string to_json(const Mapped& mapped, int indent) {
    Json json = Json::object();
    if (mapped.to_pattern) json["to_pattern"] = drawn_json(*mapped.to_pattern);
    if (mapped.to_last) json["to_last"] = drawn_json(*mapped.to_last);
    return text_of(json, indent);
}

}  // namespace lastflat::api
