#include "api/constraint_fields.h"

#include <algorithm>
#include <cmath>

namespace lastflat::api {
namespace {

constexpr double least_percent = -99.0, most_percent = 1000.0;
constexpr double least_weight = 1e-3, most_weight = 1e3;

std::string text_or_empty(ObjectReader& reader, const char* name, const RequestLimits& limits) {
    const auto field = reader.find(name);
    return field ? field->text(limits.name_bytes) : std::string();
}

/// `lateral` and `medial` have aliases.
std::string region_or_empty(ObjectReader& reader, const char* name, const RequestLimits& limits) {
    const std::string region = text_or_empty(reader, name, limits);
    return region == "exterior" ? "lateral" : region == "interior" ? "medial" : region;
}

void read_curve(ObjectReader& reader, const RequestLimits& limits, ConstraintRequest& constraint) {
    const auto curve = reader.find("curve");
    if (!curve) reader.field().fail("must have \"curve\"");
    constraint.curve = curve->text(limits.name_bytes);
}

void read_bounds(ObjectReader& reader, ConstraintRequest& constraint) {
    if (const auto least = reader.find("min_percent"))
        constraint.min_percent = least->number(least_percent, most_percent);
    if (const auto most = reader.find("max_percent"))
        constraint.max_percent = most->number(least_percent, most_percent);
    if (constraint.min_percent && constraint.max_percent &&
        *constraint.min_percent > *constraint.max_percent)
        reader.field().fail("\"min_percent\" is above \"max_percent\"");
}

/// A vertex of the file, by its id or by the name of a point.
std::optional<std::int32_t> read_vertex(ObjectReader& reader, const RequestLimits& limits,
                                        const FlattenRequest& request) {
    const auto vertex = reader.find("vertex"), point = reader.find("point");
    if (vertex && point) point->fail("is given beside \"vertex\": one of them is enough");
    if (vertex) return vertex->index();
    if (!point) return std::nullopt;
    const std::string name = point->text(limits.name_bytes);
    const auto found = std::find_if(request.points.begin(), request.points.end(),
                                    [&](const auto& p) { return p.first == name; });
    if (found == request.points.end()) point->fail("there is no point '" + name + "'");
    if (!found->second.vertex)
        point->fail("the point '" + name + "' must be given as a vertex in this version");
    return found->second.vertex;
}

void read_pin(ObjectReader& reader, const RequestLimits& limits, const FlattenRequest& request,
              ConstraintRequest& constraint) {
    const auto vertex = read_vertex(reader, limits, request);
    const auto at = reader.find("at_mm");
    if (!vertex || !at) reader.field().fail("must have \"at_mm\" and \"vertex\" or \"point\"");
    const auto items = at->items(2);
    if (items.size() != 2) at->fail("must be two numbers: x, y");
    constraint.vertex = *vertex;
    constraint.at_mm = {items[0].number(-1e5, 1e5), items[1].number(-1e5, 1e5)};
}

void read_match(ObjectReader& reader, const RequestLimits& limits, ConstraintRequest& constraint) {
    read_curve(reader, limits, constraint);
    constraint.with_curve = text_or_empty(reader, "with_curve", limits);
    if (constraint.with_curve.empty()) constraint.with_curve = constraint.curve;
    constraint.with_region = region_or_empty(reader, "with_region", limits);
}

ConstraintRequest read_constraint(const Field& field, const RequestLimits& limits,
                                  const FlattenRequest& request, bool is_lock) {
    ObjectReader reader(field);
    ConstraintRequest constraint;
    if (!is_lock) {
        const auto kind = reader.find("kind");
        if (!kind) field.fail("must have \"kind\"");
        constraint.form = static_cast<ConstraintForm>(kind->choice(constraint_names()));
    }
    switch (constraint.form) {
        case ConstraintForm::lock:
            read_curve(reader, limits, constraint);
            if (const auto keep = reader.find("keep"))
                constraint.keep = static_cast<KeepLength>(keep->choice({"edges", "total"}));
            break;
        case ConstraintForm::range:
            read_curve(reader, limits, constraint);
            read_bounds(reader, constraint);
            if (!constraint.min_percent && !constraint.max_percent)
                field.fail("must have \"min_percent\" or \"max_percent\"");
            break;
        case ConstraintForm::match: read_match(reader, limits, constraint); break;
        case ConstraintForm::straight: read_curve(reader, limits, constraint); break;
        case ConstraintForm::total_area: read_bounds(reader, constraint); break;
        case ConstraintForm::pin: read_pin(reader, limits, request, constraint); break;
    }
    constraint.region = region_or_empty(reader, "region", limits);
    if (const auto priority = reader.find("priority")) {
        const double value = priority->number(-1000, 1000);
        if (value != std::floor(value)) priority->fail("must be a whole number");
        constraint.priority = static_cast<std::int32_t>(value);
    }
    reader.finish();
    return constraint;
}

/// Whether both bind the same thing in the same way, in the same region or in every one.
bool is_repeat(const ConstraintRequest& a, const ConstraintRequest& b) {
    const bool same_place = a.region == b.region || a.region.empty() || b.region.empty();
    return a.form == b.form && a.curve == b.curve && a.vertex == b.vertex &&
           a.with_curve == b.with_curve && a.with_region == b.with_region && same_place;
}

void read_list(const char* name, bool locks, ObjectReader& reader, const RequestLimits& limits,
               FlattenRequest& request) {
    const auto list = reader.find(name);
    if (!list) return;
    std::size_t place = 0;
    for (const Field& item : list->items(limits.list)) {
        ConstraintRequest constraint = read_constraint(item, limits, request, locks);
        constraint.path = {name, std::to_string(place++)};
        for (const ConstraintRequest& earlier : request.constraints) {
            if (is_repeat(constraint, earlier))
                item.fail("binds what /" + earlier.path[0] + "/" + earlier.path[1] +
                          " binds in the same way; make one of them");
        }
        request.constraints.push_back(std::move(constraint));
    }
}

ZoneRequest read_zone(const Field& field, const RequestLimits& limits,
                      const FlattenRequest& request) {
    ObjectReader reader(field);
    ZoneRequest zone;
    int forms = 0;
    if (const auto curve = reader.find("curve")) {
        zone.curve = curve->text(limits.name_bytes);
        ++forms;
    }
    if (const auto vertex = read_vertex(reader, limits, request)) {
        zone.vertex = *vertex;
        ++forms;
    }
    if (const auto vertices = reader.find("vertices")) {
        for (const Field& item : vertices->items(limits.curve_vertices))
            zone.vertices.push_back(item.index());
        if (zone.vertices.size() < 3) vertices->fail("must have the corners of a face at least");
        ++forms;
    }
    if (forms != 1) field.fail("must have exactly one of: curve, point, vertex, vertices");
    const auto within = reader.find("within_mm");
    if (within.has_value() != zone.vertices.empty())
        field.fail("a curve or a point needs \"within_mm\", \"vertices\" have none");
    if (within) zone.within_mm = within->number(0.0, 1e4);
    const auto weight = reader.find("weight");
    if (!weight) field.fail("must have \"weight\"");
    zone.weight = weight->number(least_weight, most_weight);
    reader.finish();
    return zone;
}

void read_weights(const Field& field, const RequestLimits& limits, FlattenRequest& request) {
    constexpr std::size_t most_zones = 64;  // each looks at every triangle
    ObjectReader reader(field);
    if (const auto stretch = reader.find("stretch"))
        request.weights.stretch = stretch->number(least_weight, most_weight);
    if (const auto compression = reader.find("compression"))
        request.weights.compression = compression->number(least_weight, most_weight);
    if (const auto zones = reader.find("zones")) {
        for (const Field& item : zones->items(most_zones))
            request.weights.zones.push_back(read_zone(item, limits, request));
    }
    reader.finish();
}

MaterialRequest read_material(const Field& field) {
    ObjectReader reader(field);
    const auto stretch = reader.find("stretch_max_percent");
    const auto compress = reader.find("compress_max_percent");
    reader.finish();
    if (!stretch || !compress)
        field.fail("must have \"stretch_max_percent\" and \"compress_max_percent\"");
    return {stretch->number(0.0, most_percent), compress->number(0.0, most_percent)};
}

}  // namespace

const std::vector<std::string>& constraint_names() {
    static const std::vector<std::string> names{"lock",     "range",      "match",
                                                "straight", "total_area", "pin"};
    return names;
}

void read_constraint_fields(ObjectReader& reader, const RequestLimits& limits,
                            FlattenRequest& request) {
    read_list("locks", true, reader, limits, request);
    read_list("constraints", false, reader, limits, request);
    if (const auto conflict = reader.find("on_conflict"))
        request.on_conflict = static_cast<Conflict>(conflict->choice({"fail", "relax"}));
    if (const auto weights = reader.find("weights")) read_weights(*weights, limits, request);
    if (const auto material = reader.find("material")) request.material = read_material(*material);
}

}  // namespace lastflat::api
