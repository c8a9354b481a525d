#include "api/flatten_request.h"

#include <algorithm>

#include "api/base64.h"
#include "api/constraint_fields.h"
#include "api/object_reader.h"

namespace lastflat::api {
namespace {

std::vector<std::string> read_names(const Field& field, const RequestLimits& limits) {
    std::vector<std::string> names;
    for (const Field& item : field.items(limits.list))
        names.push_back(item.text(limits.name_bytes));
    return names;
}

Position read_position(const Field& field) {
    const auto items = field.items(3);
    if (items.size() != 3) field.fail("must be three numbers: x, y, z");
    return {items[0].number(-far_away, far_away), items[1].number(-far_away, far_away),
            items[2].number(-far_away, far_away)};
}

PlaceRequest read_place(const Field& field) {
    ObjectReader reader(field);
    PlaceRequest place;
    if (const auto vertex = reader.find("vertex")) place.vertex = vertex->index();
    if (const auto position = reader.find("position")) place.position = read_position(*position);
    reader.finish();
    if (place.vertex.has_value() == place.position.has_value()) {
        field.fail("must have either \"vertex\" or \"position\"");
    }
    return place;
}

void read_vertices(const Field& field, const RequestLimits& limits, CurveRequest& curve) {
    curve.form = CurveForm::vertices;
    for (const Field& item : field.items(limits.curve_vertices))
        curve.vertices.push_back(item.index());
    if (curve.vertices.size() < 2) field.fail("must have at least two vertices");
}

void read_polyline(const Field& field, const RequestLimits& limits, CurveRequest& curve) {
    curve.form = CurveForm::polyline;
    for (const Field& item : field.items(limits.curve_vertices))
        curve.polyline.push_back(read_position(item));
    if (curve.polyline.size() < 2) field.fail("must have at least two points");
}

CurveRequest read_curve(const std::string& name, const Field& field, const RequestLimits& limits) {
    ObjectReader reader(field);
    CurveRequest curve;
    curve.name = name;
    int forms = 0;
    if (const auto vertices = reader.find("vertices")) {
        read_vertices(*vertices, limits, curve);
        ++forms;
    }
    if (const auto polyline = reader.find("polyline")) {
        read_polyline(*polyline, limits, curve);
        ++forms;
    }
    const auto from = reader.find("from"), to = reader.find("to"), via = reader.find("via");
    if (from || to || via) {
        if (!from || !to) field.fail("a geodesic needs both \"from\" and \"to\"");
        curve.form = CurveForm::geodesic;
        curve.from = from->text(limits.name_bytes);
        curve.to = to->text(limits.name_bytes);
        if (via) curve.via = read_names(*via, limits);
        ++forms;
    }
    if (const auto border_of = reader.find("border_of")) {
        ObjectReader inner(*border_of);
        const auto groups = inner.find("groups");
        inner.finish();
        if (!groups) border_of->fail("must have \"groups\"");
        curve.form = CurveForm::border_of;
        curve.border_of_groups = read_names(*groups, limits);
        if (curve.border_of_groups.empty() || curve.border_of_groups.size() > 2)
            groups->fail("must name one group or two");
        ++forms;
    }
    if (const auto border_at = reader.find("border_at")) {
        curve.form = CurveForm::border_at;
        curve.border_at = read_place(*border_at);
        ++forms;
    }
    if (const auto line = reader.find("line")) {
        curve.form = CurveForm::line;
        curve.line = line->text(limits.name_bytes);
        ++forms;
    }
    reader.finish();
    if (forms != 1)
        field.fail(
            "must have exactly one of: vertices, polyline, from and to, border_of, border_at, "
            "line");
    return curve;
}

RegionRequest read_region(const std::string& name, const Field& field) {
    ObjectReader reader(field);
    RegionRequest region{name == "exterior" ? "lateral" : name == "interior" ? "medial" : name, {}};
    if (const auto contains = reader.find("contains")) region.contains = read_place(*contains);
    reader.finish();
    return region;
}

/// Which options a method has.
bool takes_border(Method method) {
    return method <= Method::mean_value;
}
bool takes_angles(Method method) {
    return method == Method::geodesic_fan;
}

MethodRequest read_method(const Field& field) {
    ObjectReader reader(field);
    MethodRequest method;
    if (const auto name = reader.find("name")) {
        method.name = static_cast<Method>(name->choice(method_names()));
    }
    if (const auto border = reader.find("border")) {
        method.border =
            static_cast<Border>(border->choice({"square", "circle", "hull", "floating"}));
        if (!takes_border(method.name)) border->fail("this method has a border of its own");
    }
    if (const auto angles = reader.find("angles")) {
        method.angles = static_cast<Angles>(angles->choice({"curvature", "averaged_conformal"}));
        if (!takes_angles(method.name)) angles->fail("only geodesic_fan has a choice of angles");
    }
    reader.finish();
    return method;
}

void read_surface(ObjectReader& reader, const RequestLimits& limits, FlattenRequest& request) {
    if (const auto units = reader.find("units")) {
        if (units->value.is_number())
            request.unit_mm = units->number(1e-6, 1e6);
        else
            request.units = static_cast<Unit>(units->choice(unit_names()));
    }
    if (const auto surface = reader.find("surface")) {
        ObjectReader inner(*surface);
        if (const auto groups = inner.find("groups"))
            request.surface_groups = read_names(*groups, limits);
        inner.finish();
    }
    if (const auto weld = reader.find("weld")) {
        ObjectReader inner(*weld);
        if (const auto tolerance = inner.find("tolerance_mm"))
            request.weld_tolerance_mm = tolerance->number(0.0, 1.0);
        if (const auto stitch = inner.find("stitch_mm"))
            request.stitch_mm = stitch->number(0.0, 2.0);
        if (!request.weld_tolerance_mm && !request.stitch_mm)
            weld->fail("must have \"tolerance_mm\" or \"stitch_mm\"");
        inner.finish();
    }
}

void read_geometry(ObjectReader& reader, const RequestLimits& limits, FlattenRequest& request) {
    if (const auto points = reader.find("points")) {
        for (const auto& [name, field] : points->entries(limits.list)) {
            request.points.emplace_back(name, read_place(field));
        }
    }
    if (const auto curves = reader.find("curves")) {
        for (const auto& [name, field] : curves->entries(limits.curves)) {
            request.curves.push_back(read_curve(name, field, limits));
        }
    }
    if (const auto cuts = reader.find("cuts")) request.cuts = read_names(*cuts, limits);
    if (const auto seams = reader.find("seams")) request.seams = read_names(*seams, limits);
    if (const auto holes = reader.find("holes"))
        request.holes = static_cast<Holes>(holes->choice({"auto", "keep", "open"}));
    if (const auto regions = reader.find("regions")) {
        for (const auto& [name, field] : regions->entries(limits.regions)) {
            const RegionRequest region = read_region(name, field);
            const bool twice = std::any_of(request.regions.begin(), request.regions.end(),
                                           [&](const auto& r) { return r.name == region.name; });
            if (twice) field.fail("names the region '" + region.name + "' a second time");
            request.regions.push_back(region);
        }
    }
}

FlattenRequest read_request(const Field& field, const RequestLimits& limits) {
    FlattenRequest request;
    ObjectReader reader(field);
    read_surface(reader, limits, request);
    read_geometry(reader, limits, request);
    read_constraint_fields(reader, limits, request);
    if (const auto method = reader.find("method")) request.method = read_method(*method);
    const bool weighs = request.weights.stretch != 1.0 || request.weights.compression != 1.0 ||
                        !request.weights.zones.empty();
    if (weighs && request.method.name != Method::isometric)
        reader.find("weights")->fail("only isometric weighs distortion");
    if (const auto layout = reader.find("layout")) {
        ObjectReader inner(*layout);
        if (const auto arrangement = inner.find("arrangement")) (void)arrangement->choice({"pair"});
        inner.finish();
    }
    if (const auto draw = reader.find("draw")) {
        for (const Field& item : draw->items(limits.list)) {
            (void)item.choice({"fan"});
            request.draw_fan = true;
        }
    }
    if (const auto tag = reader.find("tag")) request.tag = tag->text(256);
    reader.finish();
    return request;
}

}  // namespace

const std::vector<std::string>& unit_names() {
    static const std::vector<std::string> names{"mm", "cm", "m", "in"};
    return names;
}

const std::vector<std::string>& method_names() {
    static const std::vector<std::string> names{
        "tutte",      "chord_length",   "shape_preserving", "harmonic",
        "wachspress", "mean_value",     "virtual_border",   "geodesic_fan",
        "mips",       "green_lagrange", "isometric"};
    return names;
}

FlattenRequest flatten_request_from_json(std::string_view text, const RequestLimits& limits) {
    if (text.size() > limits.bytes) {
        throw InvalidRequest(
            "", "the request has more than " + std::to_string(limits.bytes) + " bytes");
    }
    if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) return {};
    const nlohmann::json document = parse_json(text, limits.depth);
    return read_request(Field{document, ""}, limits);
}

JsonSubmission json_submission_from_json(std::string_view text, const RequestLimits& limits) {
    const nlohmann::json document = parse_json(text, limits.depth + 1);
    ObjectReader reader(Field{document, ""});
    JsonSubmission submission;
    const auto model = reader.find("model");
    if (!model) {
        throw InvalidRequest("/model", "must be given: {\"data\": base64} or {\"asset_id\": id}");
    }
    ObjectReader inner(*model);
    const auto data = inner.find("data"), asset = inner.find("asset_id");
    inner.finish();
    if (data.has_value() == asset.has_value())
        model->fail("must have \"data\", the model in base64, or \"asset_id\", not both");
    if (asset) submission.asset_id = asset->text(limits.name_bytes);
    if (data) {
        if (!data->value.is_string()) data->fail("must be text, the model in base64");
        auto bytes = decode_base64(data->value.get_ref<const std::string&>());
        if (!bytes) data->fail("is not base64");
        submission.model = std::move(*bytes);
    }
    if (const auto request = reader.find("request")) {
        submission.request = read_request(*request, limits);
        submission.request_text = request->value.dump();
        if (submission.request_text.size() > limits.bytes)
            request->fail("has more than " + std::to_string(limits.bytes) + " bytes");
    }
    if (const auto webhook = reader.find("webhook"))
        submission.webhook = read_webhook(*webhook, WebhookScope::job);
    reader.finish();
    return submission;
}

}  // namespace lastflat::api
