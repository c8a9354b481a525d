#include "api/map_request.h"

#include "api/flatten_request.h"
#include "api/object_reader.h"

namespace lastflat::api {
namespace {

constexpr int deepest = 8;

template <std::size_t dimensions>
std::array<double, dimensions> read_point(const Field& field, std::size_t& left) {
    if (left-- == 0)
        field.fail("more than " + std::to_string(most_mapped_points) + " points in one request");
    const auto items = field.items(dimensions);
    if (items.size() != dimensions)
        field.fail("must be " + std::to_string(dimensions) + " numbers");
    std::array<double, dimensions> point{};
    for (std::size_t i = 0; i < dimensions; ++i) point[i] = items[i].number(-far_away, far_away);
    return point;
}

template <std::size_t dimensions>
Drawing<dimensions> read_drawing(const Field& field, std::size_t& left) {
    ObjectReader reader(field);
    Drawing<dimensions> drawing;
    if (const auto region = reader.find("region"))
        drawing.region = region->text(RequestLimits().name_bytes);
    if (const auto points = reader.find("points")) {
        for (const Field& item : points->items(most_mapped_points))
            drawing.points.push_back(read_point<dimensions>(item, left));
    }
    if (const auto polylines = reader.find("polylines")) {
        for (const Field& line : polylines->items(most_mapped_points)) {
            drawing.polylines.emplace_back();
            for (const Field& item : line.items(most_mapped_points))
                drawing.polylines.back().push_back(read_point<dimensions>(item, left));
            if (drawing.polylines.back().size() < 2) line.fail("must have at least two points");
        }
    }
    reader.finish();
    return drawing;
}

}  // namespace

MapRequest map_request_from_json(std::string_view text) {
    const auto json = parse_json(text, deepest);
    ObjectReader reader({json, ""});
    MapRequest request;
    std::size_t left = most_mapped_points;
    if (const auto drawing = reader.find("to_pattern"))
        request.to_pattern = read_drawing<3>(*drawing, left);
    if (const auto drawing = reader.find("to_last")) {
        request.to_last = read_drawing<2>(*drawing, left);
        if (request.to_last->region.empty())
            drawing->fail("must name the \"region\" that its points lie on");
    }
    reader.finish();
    if (!request.to_pattern && !request.to_last)
        reader.field().fail("must have \"to_pattern\" or \"to_last\"");
    return request;
}

}  // namespace lastflat::api
