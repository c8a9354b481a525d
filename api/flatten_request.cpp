#include "api/flatten_request.h"

#include <algorithm>

#include "api/constraint_fields.h"
#include "api/object_reader.h"
#include "api/request_words.h"

namespace lastflat::api {
namespace {

std::vector<std::string> read_names(const Field& field, const RequestLimits& limits) {
    std::vector<std::string> names;
    for (const Field& item : field.items(limits.list))
        names.push_back(item.text(limits.name_bytes));
    return names;
}

Vec3 read_position(const Field& field) {
    const auto items = field.items(3);
    if (items.size() != 3) field.fail("must be three numbers: x, y, z");
    return {items[0].number(-far_away, far_away), items[1].number(-far_away, far_away),
            items[2].number(-far_away, far_away)};
}

Location read_location(const Field& field) {
    ObjectReader reader(field);
    const auto vertex = reader.find("vertex"), position = reader.find("position");
    const std::optional<Index> id = vertex ? std::optional(vertex->index()) : std::nullopt;
    const std::optional<Vec3> point =
        position ? std::optional(read_position(*position)) : std::nullopt;
    reader.finish();
    if (id.has_value() == point.has_value())
        field.fail("must have either \"vertex\" or \"position\"");
    if (id) return *id;
    return *point;
}

VertexPath read_vertices(const Field& field, const RequestLimits& limits) {
    VertexPath path;
    for (const Field& item : field.items(limits.curve_vertices))
        path.vertices.push_back(item.index());
    if (path.vertices.size() < 2) field.fail("must have at least two vertices");
    return path;
}

Polyline read_polyline(const Field& field, const RequestLimits& limits) {
    Polyline polyline;
    for (const Field& item : field.items(limits.curve_vertices))
        polyline.points.push_back(read_position(item));
    if (polyline.points.size() < 2) field.fail("must have at least two points");
    return polyline;
}

GroupBorder read_border_of(const Field& field, const RequestLimits& limits) {
    ObjectReader reader(field);
    const auto groups = reader.find("groups");
    reader.finish();
    if (!groups) field.fail("must have \"groups\"");
    GroupBorder border{read_names(*groups, limits)};
    if (border.groups.empty() || border.groups.size() > 2)
        groups->fail("must name one group or two");
    return border;
}

std::optional<ShortestPath> read_geodesic(ObjectReader& reader, const RequestLimits& limits) {
    const auto from = reader.find("from"), to = reader.find("to"), via = reader.find("via");
    if (!from && !to && !via) return std::nullopt;
    if (!from || !to) reader.field().fail("a geodesic needs both \"from\" and \"to\"");
    ShortestPath path{{from->text(limits.name_bytes)}};
    const std::string end = to->text(limits.name_bytes);
    if (via) {
        for (std::string& name : read_names(*via, limits)) path.through.push_back(std::move(name));
    }
    path.through.push_back(end);
    return path;
}

CurveSource read_curve(const std::string& name, const Field& field, const RequestLimits& limits) {
    ObjectReader reader(field);
    std::vector<CurveForm> forms;
    if (const auto vertices = reader.find("vertices"))
        forms.emplace_back(read_vertices(*vertices, limits));
    if (const auto polyline = reader.find("polyline"))
        forms.emplace_back(read_polyline(*polyline, limits));
    if (auto path = read_geodesic(reader, limits)) forms.emplace_back(std::move(*path));
    if (const auto border_of = reader.find("border_of"))
        forms.emplace_back(read_border_of(*border_of, limits));
    if (const auto border_at = reader.find("border_at"))
        forms.emplace_back(BorderAt{read_location(*border_at)});
    if (const auto line = reader.find("line"))
        forms.emplace_back(NamedLine{line->text(limits.name_bytes)});
    reader.finish();
    if (forms.size() != 1)
        field.fail(
            "must have exactly one of: vertices, polyline, from and to, border_of, border_at, "
            "line");
    return {name, std::move(forms.front())};
}

RegionChoice read_region(const std::string& name, const Field& field) {
    ObjectReader reader(field);
    RegionChoice region{canonical_region(name)};
    if (const auto contains = reader.find("contains")) region.inside = read_location(*contains);
    reader.finish();
    return region;
}

/// Whether a method has a choice of borders.
bool takes_border(MethodName method) {
    switch (method) {
        case MethodName::tutte:
        case MethodName::chord_length:
        case MethodName::shape_preserving:
        case MethodName::harmonic:
        case MethodName::wachspress:
        case MethodName::mean_value: return true;
        case MethodName::virtual_border:
        case MethodName::geodesic_fan:
        case MethodName::mips:
        case MethodName::green_lagrange:
        case MethodName::isometric: return false;
    }
    return false;
}

MethodOptions read_method(const Field& field) {
    ObjectReader reader(field);
    MethodOptions method;
    if (const auto name = reader.find("name")) method.name = name->choice(method_words);
    if (const auto border = reader.find("border")) {
        method.border = border->choice(border_words);
        if (!takes_border(method.name)) border->fail("this method has a border of its own");
    }
    if (const auto angles = reader.find("angles")) {
        method.angles = angles->choice(angle_words);
        if (method.name != MethodName::geodesic_fan)
            angles->fail("only geodesic_fan has a choice of angles");
    }
    reader.finish();
    return method;
}

void read_surface(ObjectReader& reader, const RequestLimits& limits, WeldOptions& weld) {
    if (const auto units = reader.find("units")) {
        weld.unit_mm =
            units->value.is_number() ? units->number(1e-6, 1e6) : units->choice(unit_words);
    }
    if (const auto length = reader.find("last_length_mm"))
        weld.last_length_mm = length->number(50.0, 500.0);
    if (const auto surface = reader.find("surface")) {
        ObjectReader inner(*surface);
        if (const auto groups = inner.find("groups")) weld.groups = read_names(*groups, limits);
        inner.finish();
    }
    if (const auto field = reader.find("weld")) {
        ObjectReader inner(*field);
        if (const auto coincident = inner.find("coincident"))
            weld.coincident = coincident->choice(coincident_words);
        if (const auto tolerance = inner.find("tolerance_mm"))
            weld.tolerance_mm = tolerance->number(0.0, 1.0);
        if (const auto stitch = inner.find("stitch_mm")) weld.stitch_mm = stitch->number(0.0, 2.0);
        if (!weld.coincident && !weld.tolerance_mm && !weld.stitch_mm)
            field->fail("must have \"coincident\", \"tolerance_mm\" or \"stitch_mm\"");
        if (weld.coincident == Coincident::keep && weld.tolerance_mm)
            field->fail("cannot join vertices within \"tolerance_mm\" and keep coincident ones");
        inner.finish();
    }
}

void read_geometry(ObjectReader& reader, const RequestLimits& limits, Request& request) {
    if (const auto points = reader.find("points")) {
        for (const auto& [name, field] : points->entries(limits.list))
            request.points.push_back({name, read_location(field)});
    }
    if (const auto curves = reader.find("curves")) {
        for (const auto& [name, field] : curves->entries(limits.curves))
            request.curves.push_back(read_curve(name, field, limits));
    }
    CutOptions& cut = request.cut;
    if (const auto cuts = reader.find("cuts")) cut.cuts = read_names(*cuts, limits);
    if (const auto seams = reader.find("seams")) cut.seams = read_names(*seams, limits);
    if (const auto holes = reader.find("holes")) cut.holes = holes->choice(hole_words);
    if (const auto features = reader.find("features"))
        cut.features = features->choice(feature_words);
    if (const auto regions = reader.find("regions")) {
        for (const auto& [name, field] : regions->entries(limits.regions)) {
            const RegionChoice region = read_region(name, field);
            const bool twice = std::any_of(cut.regions.begin(), cut.regions.end(),
                                           [&](const auto& r) { return r.name == region.name; });
            if (twice) field.fail("names the region '" + region.name + "' a second time");
            cut.regions.push_back(region);
        }
    }
}

/// The fan, and one shading at most.
void read_draw(const Field& field, Request& request) {
    bool is_shaded = false;
    for (const Field& item : field.items(2)) {
        const auto shading = item.choice(draw_words);
        if (shading ? is_shaded : request.draw_fan)
            item.fail(shading ? "only one quantity can be shown by colour" : "stands here twice");
        if (shading) request.shading = *shading;
        (shading ? is_shaded : request.draw_fan) = true;
    }
}

void read_include(const Field& field, Request& request) {
    for (const Field& item : field.items(std::size(include_words))) {
        (void)item.choice(include_words);
        request.include_fan = true;
    }
}

bool weighs(const DistortionWeights& weights) {
    return !weights.even() || !weights.zones.empty();
}

}  // namespace

FlattenRequest read_flatten_request(const Field& field, const RequestLimits& limits) {
    FlattenRequest request;
    Request& asked = request.asked;
    ObjectReader reader(field);
    read_surface(reader, limits, asked.weld);
    read_geometry(reader, limits, asked);
    read_constraint_fields(reader, limits, asked);
    if (const auto method = reader.find("method")) asked.method = read_method(*method);
    if (weighs(asked.weights) && asked.method.name != MethodName::isometric)
        reader.find("weights")->fail("only isometric weighs distortion");
    if (const auto layout = reader.find("layout")) {
        constexpr Word<bool> arrangements[]{{"pair", true}};
        ObjectReader inner(*layout);
        if (const auto arrangement = inner.find("arrangement"))
            (void)arrangement->choice(arrangements);
        inner.finish();
    }
    if (const auto include = reader.find("include")) read_include(*include, asked);
    if (const auto draw = reader.find("draw")) read_draw(*draw, asked);
    if (const auto tag = reader.find("tag")) request.tag = tag->text(256);
    reader.finish();
    return request;
}

FlattenRequest flatten_request_from_json(std::string_view text, const RequestLimits& limits) {
    if (text.size() > limits.bytes) {
        throw InvalidRequest(
            "", "the request has more than " + std::to_string(limits.bytes) + " bytes");
    }
    if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) return {};
    const nlohmann::json document = parse_json(text, limits.depth);
    return read_flatten_request(Field{document, ""}, limits);
}

std::string without_tag(const std::string& request) {
    constexpr std::size_t long_text = 1 << 20;
    if (request.size() > long_text) return request;
    if (request.find_first_not_of(" \t\r\n") == std::string::npos) return "{}";
    nlohmann::json document = nlohmann::json::parse(request);
    document.erase("tag");
    return document.dump(-1, ' ', true);
}

}  // namespace lastflat::api
