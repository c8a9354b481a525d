#include "core/locate/curves.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <set>

#include "core/locate/border_loop.h"
#include "core/locate/curve_error.h"
#include "core/locate/follow_surface.h"
#include "core/locate/group_line.h"
#include "core/locate/shortest_paths.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

std::string millimetres(double length) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%.3f mm", length);
    return text.data();
}

Index located_vertex(const SurfaceMesh& surface, const CurveSource& source, std::size_t item) {
    const Index id = source.vertices[item];
    if (id < 0 || id >= static_cast<Index>(surface.welded_to.size())) {
        fail_curve(source.name, "vertices", item,
                   "vertex " + std::to_string(id) + " does not exist (the model has " +
                       std::to_string(surface.welded_to.size()) + ", counted from 0)");
    }
    const Index vertex = surface.welded_to[static_cast<std::size_t>(id)];
    if (!surface.is_on_surface(vertex)) {
        fail_curve(source.name, "vertices", item,
                   "vertex " + std::to_string(id) + " is not on the selected faces, at " +
                       place(surface.position(vertex)),
                   surface.position(vertex));
    }
    return vertex;
}

void check_edge(const SurfaceMesh& surface, const CurveSource& source, std::size_t item, Index a,
                Index b) {
    const auto edge =
        surface.mesh.find_halfedge(OpenMesh::VertexHandle(a), OpenMesh::VertexHandle(b));
    if (edge.is_valid()) return;
    fail_curve(source.name, "vertices", item,
               "vertices " + std::to_string(source.vertices[item - 1]) + " and " +
                   std::to_string(source.vertices[item]) + " share no edge; they are " +
                   millimetres((surface.position(a) - surface.position(b)).norm()) + " apart, at " +
                   place(surface.position(a)),
               surface.position(a));
}

std::vector<Index> vertex_path(const SurfaceMesh& surface, const CurveSource& source) {
    if (source.vertices.size() < 2)
        fail_curve(source.name, "vertices", 0, "a curve needs two vertices");
    std::vector<Index> path;
    std::set<Index> seen;
    for (std::size_t i = 0; i < source.vertices.size(); ++i) {
        const Index vertex = located_vertex(surface, source, i);
        const bool closes = i + 1 == source.vertices.size() && i > 2 && vertex == path.front();
        if (!seen.insert(vertex).second && !closes) {
            fail_curve(source.name, "vertices", i,
                       "the curve meets itself at vertex " + std::to_string(source.vertices[i]) +
                           ", at " + place(surface.position(vertex)),
                       surface.position(vertex));
        }
        path.push_back(vertex);
        if (i > 0) check_edge(surface, source, i, path[i - 1], path[i]);
    }
    return path;
}

std::vector<SurfacePlace> places_of(const std::vector<Index>& vertices) {
    std::vector<SurfacePlace> places;
    places.reserve(vertices.size());
    for (const Index v : vertices) places.push_back(SurfacePlace::at_vertex(v));
    return places;
}

/// Finds what is drawn in space, and the named points.
class Drawing {
public:
    Drawing(const SurfaceMesh& surface, const std::vector<PointSource>& points)
        : surface_(surface), points_(points) {}

    /// The ends are put on other lines or the border where they are near and were drawn.
    [[nodiscard]] SurfacePlace named(const CurveSource& source, std::size_t item,
                                     const std::vector<SurfaceLine>& others) {
        const std::string& name = source.through[item];
        const auto point = std::find_if(points_.begin(), points_.end(),
                                        [&](const PointSource& p) { return p.name == name; });
        const auto fail = [&](const std::string& what) {
            const std::size_t last = source.through.size() - 1;
            const std::string field = item == 0 ? "from" : item == last ? "to" : "via";
            fail_curve(source.name, field, field == "via" ? std::optional(item - 1) : std::nullopt,
                       what);
        };
        if (point == points_.end()) fail("there is no point '" + name + "' in \"points\"");
        if (!point->vertex) {
            SurfacePlace place = on_surface(*point->position, fail);
            if (item == 0 || item + 1 == source.through.size()) snap(place, others);
            return place;
        }
        if (!surface_.is_on_surface(*point->vertex))
            fail("vertex " + std::to_string(*point->vertex) + " is not on the selected faces");
        return SurfacePlace::at_vertex(
            surface_.welded_to[static_cast<std::size_t>(*point->vertex)]);
    }

    /// The polyline on the surface, its ends on other lines or the border where they are near.
    [[nodiscard]] std::vector<SurfacePlace> drawn(const std::string& name, const std::string& field,
                                                  const Points3& polyline,
                                                  const std::vector<SurfaceLine>& others) {
        std::vector<SurfacePlace> stops;
        for (std::size_t i = 0; i < polyline.size(); ++i) {
            stops.push_back(on_surface(polyline[i], [&](const std::string& what) {
                fail_curve(name, field, i, what, polyline[i]);
            }));
        }
        if (stops.size() < 2) fail_curve(name, field, 0, "a curve needs two points");
        const bool closed = polyline.size() > 3 && polyline.front() == polyline.back();
        if (!closed) {
            snap(stops.front(), others);
            snap(stops.back(), others);
        }
        std::vector<SurfacePlace> line{stops.front()};
        for (std::size_t i = 1; i < stops.size(); ++i) {
            if ((position_of(surface_, stops[i]) - position_of(surface_, line.back())).norm() ==
                0.0)
                continue;
            if (follow_surface(search(), surface_, stops[i], line)) continue;
            fail_curve(name, field, i,
                       "the line from the point before cannot be followed on the surface, near " +
                           place(polyline[i]) + "; give more points there",
                       polyline[i]);
        }
        return line;
    }

private:
    const SurfaceSearch& search() {
        if (!search_) search_.emplace(surface_);
        return *search_;
    }

    template <class Fail>
    SurfacePlace on_surface(const Vec3& position, const Fail& fail) {
        const auto nearest = search().nearest(position);
        const double most = drawn_reach * search().size();
        if (nearest.distance > most)
            fail("the point is " + millimetres(nearest.distance) +
                 " away from the surface (at most " + millimetres(most) +
                 "); are the units right?");
        return nearest.place;
    }

    void snap(SurfacePlace& end, const std::vector<SurfaceLine>& others) {
        const Vec3 at = position_of(surface_, end);
        SurfacePlace best = end;
        double least = drawn_end_reach * search().size();
        const auto consider = [&](const SurfacePlace& a, const SurfacePlace& b) {
            const Vec3 from = position_of(surface_, a), along = position_of(surface_, b) - from;
            if (along.squaredNorm() == 0.0) return;
            const double share = std::clamp(along.dot(at - from) / along.squaredNorm(), 0.0, 1.0);
            const double distance = (from + share * along - at).norm();
            if (distance >= least) return;
            least = distance;
            best = share == 0.0 ? a : share == 1.0 ? b : between(a, b, share);
        };
        for (const SurfaceLine& line : others) {
            for (std::size_t i = 1; i < line.places.size(); ++i)
                consider(line.places[i - 1], line.places[i]);
        }
        for (const auto edge : surface_.mesh.edges()) {
            if (!surface_.mesh.is_boundary(edge)) continue;
            const auto h = surface_.mesh.halfedge_handle(edge, 0);
            consider(SurfacePlace::at_vertex(surface_.mesh.from_vertex_handle(h).idx()),
                     SurfacePlace::at_vertex(surface_.mesh.to_vertex_handle(h).idx()));
        }
        end = best;
    }

    const SurfaceMesh& surface_;
    const std::vector<PointSource>& points_;
    std::optional<SurfaceSearch> search_;
};

Points3 line_of_model(const SurfaceMesh& surface, const CurveSource& source) {
    for (const ModelLine& line : surface.lines) {
        if (std::find(line.names.begin(), line.names.end(), source.line) != line.names.end())
            return line.points;
    }
    fail_curve(source.name, "line", std::nullopt,
               "the model has no line named '" + source.line + "'");
}

/// What ends on others comes after them.
int rank(const CurveSource& source) {
    if (!source.polyline.empty() || !source.line.empty()) return 2;
    return source.through.empty() ? 0 : 1;
}

}  // namespace

std::vector<SurfaceLine> locate_curves(const SurfaceMesh& surface,
                                       const std::vector<CurveSource>& sources,
                                       const std::vector<PointSource>& points) {
    Drawing drawing(surface, points);
    std::vector<SurfaceLine> lines(sources.size());
    std::vector<SurfaceLine> known;
    for (const int turn : {0, 1, 2}) {
        for (std::size_t i = 0; i < sources.size(); ++i) {
            const CurveSource& source = sources[i];
            if (rank(source) != turn) continue;
            SurfaceLine& line = lines[i];
            line.name = source.name;
            line.snap = turn < 2 ? tolerance::geodesic_snap : tolerance::drawn_snap;
            if (!source.polyline.empty()) {
                line.places = drawing.drawn(source.name, "polyline", source.polyline, known);
            } else if (!source.line.empty()) {
                line.places =
                    drawing.drawn(source.name, "line", line_of_model(surface, source), known);
            } else if (!source.through.empty()) {
                std::vector<SurfacePlace> stops;
                for (std::size_t k = 0; k < source.through.size(); ++k)
                    stops.push_back(drawing.named(source, k, known));
                line.places = shortest_paths(surface, stops);
            } else if (!source.border_of.empty()) {
                line.places = places_of(group_line(surface, source));
            } else if (source.border_at) {
                line.places = places_of(border_loop(surface, source));
            } else {
                line.places = places_of(vertex_path(surface, source));
            }
            known.push_back(line);
        }
    }
    return lines;
}

}  // namespace lastflat
