#include "api/constraint_fields.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "api/request_words.h"
#include "core/overloaded.h"

namespace lastflat::api {
namespace {

constexpr double least_percent = -99.0, most_percent = 1000.0;
constexpr double least_weight = 1e-3, most_weight = 1e3;

using Demand = decltype(Constraint::demand);

std::string text_or_empty(ObjectReader& reader, const char* name, const RequestLimits& limits) {
    const auto field = reader.find(name);
    return field ? field->text(limits.name_bytes) : std::string();
}

std::string read_region(ObjectReader& reader, const RequestLimits& limits,
                        const char* name = "region") {
    return canonical_region(text_or_empty(reader, name, limits));
}

std::string read_curve(ObjectReader& reader, const RequestLimits& limits) {
    const auto curve = reader.find("curve");
    if (!curve) reader.field().fail("must have \"curve\"");
    return curve->text(limits.name_bytes);
}

struct Bounds {
    std::optional<double> least, most;
};

Bounds read_bounds(ObjectReader& reader) {
    Bounds bounds;
    if (const auto least = reader.find("min_percent"))
        bounds.least = least->number(least_percent, most_percent);
    if (const auto most = reader.find("max_percent"))
        bounds.most = most->number(least_percent, most_percent);
    if (bounds.least && bounds.most && *bounds.least > *bounds.most)
        reader.field().fail("\"min_percent\" is above \"max_percent\"");
    return bounds;
}

constexpr double unbounded = std::numeric_limits<double>::infinity();

/// A vertex of the file, by its id or by the name of a point.
std::optional<Index> read_vertex(ObjectReader& reader, const RequestLimits& limits,
                                 const Request& request) {
    const auto vertex = reader.find("vertex"), point = reader.find("point");
    if (vertex && point) point->fail("is given beside \"vertex\": one of them is enough");
    if (vertex) return vertex->index();
    if (!point) return std::nullopt;
    const std::string name = point->text(limits.name_bytes);
    const auto found = std::find_if(request.points.begin(), request.points.end(),
                                    [&](const PointSource& p) { return p.name == name; });
    if (found == request.points.end()) point->fail("there is no point '" + name + "'");
    const auto* id = std::get_if<Index>(&found->location);
    if (id == nullptr)
        point->fail("the point '" + name + "' must be given as a vertex in this version");
    return *id;
}

using ReadDemand = Demand (*)(ObjectReader&, const RequestLimits&, const Request&);

Demand read_lock(ObjectReader& reader, const RequestLimits& limits, const Request&) {
    Lock lock{read_curve(reader, limits)};
    if (const auto keep = reader.find("keep")) lock.keep = keep->choice(keep_words);
    lock.region = read_region(reader, limits);
    return lock;
}

Demand read_range(ObjectReader& reader, const RequestLimits& limits, const Request&) {
    const std::string curve = read_curve(reader, limits);
    const Bounds bounds = read_bounds(reader);
    if (!bounds.least && !bounds.most)
        reader.field().fail("must have \"min_percent\" or \"max_percent\"");
    return Range{curve, bounds.least.value_or(-unbounded), bounds.most.value_or(unbounded),
                 read_region(reader, limits)};
}

Demand read_match(ObjectReader& reader, const RequestLimits& limits, const Request&) {
    const std::string curve = read_curve(reader, limits);
    const std::string with_curve = text_or_empty(reader, "with_curve", limits);
    return Match{curve, read_region(reader, limits), with_curve.empty() ? curve : with_curve,
                 read_region(reader, limits, "with_region")};
}

Demand read_straight(ObjectReader& reader, const RequestLimits& limits, const Request&) {
    return Straight{read_curve(reader, limits), read_region(reader, limits)};
}

/// An area with neither bound is kept exactly.
Demand read_total_area(ObjectReader& reader, const RequestLimits& limits, const Request&) {
    const Bounds bounds = read_bounds(reader);
    const std::string region = read_region(reader, limits);
    if (!bounds.least && !bounds.most) return TotalArea{0.0, 0.0, region};
    return TotalArea{bounds.least.value_or(-unbounded), bounds.most.value_or(unbounded), region};
}

Demand read_pin(ObjectReader& reader, const RequestLimits& limits, const Request& request) {
    const auto vertex = read_vertex(reader, limits, request);
    const auto at = reader.find("at_mm");
    if (!vertex || !at) reader.field().fail("must have \"at_mm\" and \"vertex\" or \"point\"");
    const auto items = at->items(2);
    if (items.size() != 2) at->fail("must be two numbers: x, y");
    return Pin{*vertex,
               {items[0].number(-1e5, 1e5), items[1].number(-1e5, 1e5)},
               read_region(reader, limits)};
}

constexpr Word<ReadDemand> kinds[]{
    {"lock", read_lock},         {"range", read_range},           {"match", read_match},
    {"straight", read_straight}, {"total_area", read_total_area}, {"pin", read_pin}};

Constraint read_constraint(const Field& field, const RequestLimits& limits, const Request& request,
                           bool is_lock) {
    ObjectReader reader(field);
    ReadDemand read = read_lock;
    if (!is_lock) {
        const auto kind = reader.find("kind");
        if (!kind) field.fail("must have \"kind\"");
        read = kind->choice(kinds);
    }
    Constraint constraint{read(reader, limits, request)};
    if (const auto priority = reader.find("priority")) {
        const double value = priority->number(-1000, 1000);
        if (value != std::floor(value)) priority->fail("must be a whole number");
        constraint.priority = static_cast<int>(value);
    }
    reader.finish();
    return constraint;
}

/// What a demand binds, whatever it asks for.
struct Bound {
    std::string curve, region;
    std::string with_curve{}, with_region{};
    Index vertex = -1;
};

Bound bound_by(const Demand& demand) {
    return std::visit(Overloaded{[](const Lock& d) {
                                     return Bound{d.curve, d.region};
                                 },
                                 [](const Range& d) {
                                     return Bound{d.curve, d.region};
                                 },
                                 [](const Match& d) {
                                     return Bound{d.curve, d.region, d.with_curve, d.with_region};
                                 },
                                 [](const Straight& d) {
                                     return Bound{d.curve, d.region};
                                 },
                                 [](const TotalArea& d) {
                                     return Bound{{}, d.region};
                                 },
                                 [](const Pin& d) {
                                     return Bound{{}, d.region, {}, {}, d.vertex};
                                 },
                                 [](const Seam& d) {
                                     return Bound{d.curve, {}};
                                 }},
                      demand);
}

/// Whether both bind the same thing in the same way, in the same region or in every one.
bool is_repeat(const Constraint& one, const Constraint& other) {
    const Bound a = bound_by(one.demand), b = bound_by(other.demand);
    const bool same_region = a.region == b.region || a.region.empty() || b.region.empty();
    return one.demand.index() == other.demand.index() && a.curve == b.curve &&
           a.vertex == b.vertex && a.with_curve == b.with_curve && a.with_region == b.with_region &&
           same_region;
}

void read_list(const char* name, bool locks, ObjectReader& reader, const RequestLimits& limits,
               Request& request) {
    const auto list = reader.find(name);
    if (!list) return;
    std::size_t index = 0;
    for (const Field& item : list->items(limits.list)) {
        Constraint constraint = read_constraint(item, limits, request, locks);
        constraint.option = {name, std::to_string(index++)};
        for (const Constraint& earlier : request.constraints) {
            if (is_repeat(constraint, earlier))
                item.fail("binds what /" + earlier.option[0] + "/" + earlier.option[1] +
                          " binds in the same way; make one of them");
        }
        request.constraints.push_back(std::move(constraint));
    }
}

Zone read_zone(const Field& field, const RequestLimits& limits, const Request& request) {
    ObjectReader reader(field);
    Zone zone;
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

DistortionWeights read_weights(const Field& field, const RequestLimits& limits,
                               const Request& request) {
    constexpr std::size_t most_zones = 64;  // each looks at every triangle
    DistortionWeights weights;
    ObjectReader reader(field);
    if (const auto stretch = reader.find("stretch"))
        weights.stretch = stretch->number(least_weight, most_weight);
    if (const auto compression = reader.find("compression"))
        weights.compression = compression->number(least_weight, most_weight);
    if (const auto zones = reader.find("zones")) {
        for (const Field& item : zones->items(most_zones))
            weights.zones.push_back(read_zone(item, limits, request));
    }
    reader.finish();
    return weights;
}

MaterialLimits read_material(const Field& field) {
    ObjectReader reader(field);
    const auto stretch = reader.find("stretch_max_percent");
    const auto compress = reader.find("compress_max_percent");
    reader.finish();
    if (!stretch || !compress)
        field.fail("must have \"stretch_max_percent\" and \"compress_max_percent\"");
    return {stretch->number(0.0, most_percent), compress->number(0.0, most_percent)};
}

}  // namespace

std::string canonical_region(const std::string& name) {
    if (name == "exterior") return region_name::lateral;
    return name == "interior" ? region_name::medial : name;
}

void read_constraint_fields(ObjectReader& reader, const RequestLimits& limits, Request& request) {
    read_list("locks", true, reader, limits, request);
    read_list("constraints", false, reader, limits, request);
    if (const auto conflict = reader.find("on_conflict"))
        request.on_conflict = conflict->choice(conflict_words);
    if (const auto weights = reader.find("weights"))
        request.weights = read_weights(*weights, limits, request);
    if (const auto material = reader.find("material")) request.material = read_material(*material);
}

}  // namespace lastflat::api
