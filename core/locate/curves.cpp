#include "core/locate/curves.h"

#include <algorithm>
#include <limits>
#include <set>

#include "core/locate/border_loop.h"
#include "core/locate/curve_error.h"
#include "core/locate/follow_surface.h"
#include "core/locate/group_line.h"
#include "core/locate/shortest_paths.h"
#include "core/numerics/geometry.h"
#include "core/numerics/tolerances.h"
#include "core/text.h"

namespace lastflat {
namespace {

Index located_vertex(const SurfaceMesh& surface, const std::string& curve, std::size_t item,
                     Index id) {
    if (id < 0 || id >= static_cast<Index>(surface.welded_to.size())) {
        fail_curve(curve, "vertices", item,
                   "vertex " + std::to_string(id) + " does not exist (the model has " +
                       std::to_string(surface.welded_to.size()) + ", counted from 0)");
    }
    const Index vertex = surface.welded_to[static_cast<std::size_t>(id)];
    if (!surface.is_on_surface(vertex)) {
        fail_curve(curve, "vertices", item,
                   "vertex " + std::to_string(id) + " is not on the selected faces, at " +
                       position_text(surface.position(vertex)),
                   surface.position(vertex));
    }
    return vertex;
}

/// Between an item of a path and the one before.
void check_edge(const SurfaceMesh& surface, const std::string& curve, std::size_t item,
                const std::vector<Index>& ids, Index a, Index b) {
    const auto edge =
        surface.mesh.find_halfedge(OpenMesh::VertexHandle(a), OpenMesh::VertexHandle(b));
    if (edge.is_valid()) return;
    fail_curve(curve, "vertices", item,
               "vertices " + std::to_string(ids[item - 1]) + " and " + std::to_string(ids[item]) +
                   " share no edge; they are " +
                   fixed_text((surface.position(a) - surface.position(b)).norm(), 3) +
                   " mm apart, at " + position_text(surface.position(a)),
               surface.position(a));
}

std::vector<Index> vertex_path(const SurfaceMesh& surface, const std::string& curve,
                               const std::vector<Index>& ids) {
    if (ids.size() < 2) fail_curve(curve, "vertices", 0, "a curve needs two vertices");
    std::vector<Index> path;
    std::set<Index> seen;
    for (std::size_t i = 0; i < ids.size(); ++i) {
        const Index vertex = located_vertex(surface, curve, i, ids[i]);
        const bool closes = i + 1 == ids.size() && i > 2 && vertex == path.front();
        if (!seen.insert(vertex).second && !closes) {
            fail_curve(curve, "vertices", i,
                       "the curve meets itself at vertex " + std::to_string(ids[i]) + ", at " +
                           position_text(surface.position(vertex)),
                       surface.position(vertex));
        }
        path.push_back(vertex);
        if (i > 0) check_edge(surface, curve, i, ids, path[i - 1], path[i]);
    }
    return path;
}

std::vector<SurfacePoint> points_of(const std::vector<Index>& vertices) {
    std::vector<SurfacePoint> points;
    points.reserve(vertices.size());
    for (const Index v : vertices) points.push_back(SurfacePoint::at_vertex(v));
    return points;
}

Points3 line_of_model(const SurfaceMesh& surface, const std::string& curve,
                      const std::string& name) {
    for (const ModelLine& line : surface.lines) {
        if (contains(line.names, name)) return line.points;
    }
    fail_curve(curve, "line", std::nullopt, "the model has no line named '" + name + "'");
}

bool is_drawn(const CurveForm& form) {
    return std::holds_alternative<Polyline>(form) || std::holds_alternative<NamedLine>(form);
}

bool is_closed(const Points3& line) {
    return line.size() > 3 && line.front() == line.back();
}

/// Finds one curve after the other.
class Search {
public:
    /// `search`: of the surface, if there is one already.
    Search(const SurfaceMesh& surface, const std::vector<PointSource>& points,
           std::vector<SurfaceLine> before = {}, const SurfaceSearch* search = nullptr)
        : surface_(surface), points_(points), known_(search), found_(std::move(before)) {}

    /// What was found before, and these.
    [[nodiscard]] std::vector<SurfaceLine> run(const std::vector<CurveSource>& sources) {
        for (const CurveSource& source : sources) {
            snap_ = tolerance::geodesic_snap;
            starts_on_line_ = ends_on_line_ = false;
            auto line = std::visit([&](const auto& form) { return this->line(source.name, form); },
                                   source.form);
            found_.push_back({source.name, std::move(line), snap_, starts_on_line_, ends_on_line_});
        }
        return std::move(found_);
    }

private:
    [[nodiscard]] std::vector<SurfacePoint> line(const std::string& name,
                                                 const VertexPath& path) const {
        return points_of(vertex_path(surface_, name, path.vertices));
    }
    [[nodiscard]] std::vector<SurfacePoint> line(const std::string& name,
                                                 const GroupBorder& border) const {
        return points_of(group_line(surface_, name, border));
    }
    [[nodiscard]] std::vector<SurfacePoint> line(const std::string& name,
                                                 const BorderAt& border) const {
        return points_of(border_loop(surface_, name, border));
    }
    [[nodiscard]] std::vector<SurfacePoint> line(const std::string& name,
                                                 const ShortestPath& path) {
        std::vector<SurfacePoint> stops;
        for (std::size_t i = 0; i < path.through.size(); ++i) stops.push_back(named(name, path, i));
        return shortest_paths(surface_, stops);
    }
    [[nodiscard]] std::vector<SurfacePoint> line(const std::string& name,
                                                 const Polyline& polyline) {
        return drawn(name, "polyline", polyline.points);
    }
    [[nodiscard]] std::vector<SurfacePoint> line(const std::string& name, const NamedLine& line) {
        return drawn(name, "line", line_of_model(surface_, name, line.line));
    }

    /// The ends are put on other lines or the border where they are near and were drawn.
    [[nodiscard]] SurfacePoint named(const std::string& curve, const ShortestPath& path,
                                     std::size_t item) {
        const std::string& name = path.through[item];
        const std::size_t last = path.through.size() - 1;
        const auto fail = [&](const std::string& what) {
            const std::string field = item == 0 ? "from" : item == last ? "to" : "via";
            fail_curve(curve, field, field == "via" ? std::optional(item - 1) : std::nullopt, what);
        };
        const auto point = std::find_if(points_.begin(), points_.end(),
                                        [&](const PointSource& p) { return p.name == name; });
        if (point == points_.end()) fail("there is no point '" + name + "'");
        if (const auto* position = std::get_if<Vec3>(&point->location)) {
            SurfacePoint end = on_surface(*position, fail);
            if (item == 0) starts_on_line_ = snap(end);
            if (item == last) ends_on_line_ = snap(end);
            return end;
        }
        const Index vertex = std::get<Index>(point->location);
        if (!surface_.is_on_surface(vertex))
            fail("vertex " + std::to_string(vertex) + " is not on the selected faces");
        return SurfacePoint::at_vertex(surface_.welded_to[static_cast<std::size_t>(vertex)]);
    }

    /// The polyline on the surface, its ends on other lines or the border where they are near.
    [[nodiscard]] std::vector<SurfacePoint> drawn(const std::string& name, const std::string& field,
                                                  const Points3& polyline) {
        std::vector<SurfacePoint> stops = on_surface(name, field, polyline);
        if (stops.size() < 2) fail_curve(name, field, 0, "a curve needs two points");
        if (!runs_on_surface(polyline, stops)) snap_ = tolerance::drawn_snap;
        if (!is_closed(polyline)) {
            starts_on_line_ = snap(stops.front());
            ends_on_line_ = snap(stops.back());
        }
        std::vector<SurfacePoint> line{stops.front()};
        for (std::size_t i = 1; i < stops.size(); ++i) {
            if ((position_of(surface_, stops[i]) - position_of(surface_, line.back())).norm() ==
                0.0)
                continue;
            if (follow_surface(search(), surface_, stops[i], line)) continue;
            if (follow_shortest_path(stops[i], line)) continue;
            fail_curve(name, field, i,
                       "the line from the point before cannot be followed on the surface, near " +
                           position_text(polyline[i]) + "; give more points there",
                       polyline[i]);
        }
        return line;
    }

    /// Where the surface is folded or pinched a plane does not lead through it, but a shortest path
    /// does. Whether it goes about as straight as the line was drawn.
    [[nodiscard]] bool follow_shortest_path(const SurfacePoint& to,
                                            std::vector<SurfacePoint>& line) const {
        constexpr double longest = 1.5;  // of the straight way
        const std::vector<SurfacePoint> path = shortest_paths(surface_, {line.back(), to});
        double length = 0.0;
        for (std::size_t i = 1; i < path.size(); ++i)
            length += (position_of(surface_, path[i]) - position_of(surface_, path[i - 1])).norm();
        const double straight =
            (position_of(surface_, to) - position_of(surface_, line.back())).norm();
        if (length > longest * straight) return false;
        line.insert(line.end(), path.begin() + 1, path.end());
        return true;
    }

    /// Whether nothing is left to be found: it goes from one face into the next as it was given.
    [[nodiscard]] bool runs_on_surface(const Points3& polyline,
                                       const std::vector<SurfacePoint>& stops) {
        const double round_off = tolerance::on_edge * search().size();
        for (std::size_t i = 0; i < stops.size(); ++i) {
            if ((position_of(surface_, stops[i]) - polyline[i]).norm() > round_off) return false;
            if (i > 0 && !share_a_face(surface_, stops[i - 1], stops[i])) return false;
        }
        return true;
    }

    const SurfaceSearch& search() {
        if (known_ == nullptr) known_ = &made_.emplace(surface_);
        return *known_;
    }

    template <class Fail>
    SurfacePoint on_surface(const Vec3& position, const Fail& fail) {
        const auto nearest = search().nearest(position);
        const double most = tolerance::drawn_reach * search().size();
        if (nearest.distance > most)
            fail("the point is " + fixed_text(nearest.distance, 3) +
                 " mm away from the surface (at most " + fixed_text(most, 3) +
                 " mm); are the units right?");
        return nearest.point;
    }

    /// All points of a drawn line.
    std::vector<SurfacePoint> on_surface(const std::string& name, const std::string& field,
                                         const Points3& polyline) {
        const double most = tolerance::drawn_reach * search().size();
        std::vector<SurfacePoint> stops;
        std::vector<double> off;
        for (const Vec3& position : polyline) {
            const auto nearest = search().nearest(position);
            stops.push_back(nearest.point);
            off.push_back(nearest.distance);
        }
        const auto too_far = [&](double distance) { return distance > most; };
        const auto first = std::find_if(off.begin(), off.end(), too_far);
        if (first == off.end()) return stops;
        const auto last = std::find_if_not(first, off.end(), too_far) - 1;
        const auto worst = std::max_element(first, last + 1);
        const auto place = [&](auto point) {
            return position_text(polyline[static_cast<std::size_t>(point - off.begin())]);
        };
        const std::string limit =
            " mm away from the surface (at most " + fixed_text(most, 3) + " mm)";
        const std::string what = first == last ? "the point is " + fixed_text(*first, 3) + limit
                                               : "from " + place(first) + " to " + place(last) +
                                                     " it is up to " + fixed_text(*worst, 3) +
                                                     limit + ", furthest at " + place(worst);
        fail_curve(name, field, static_cast<std::size_t>(first - off.begin()),
                   what + "; are the units right? Draw it on the surface, or from point to point",
                   polyline[static_cast<std::size_t>(worst - off.begin())]);
    }

    /// Puts an end on another line or the border. Whether one is near.
    bool snap(SurfacePoint& end) {
        const Vec3 at = position_of(surface_, end);
        SurfacePoint best = end;
        const double reach = tolerance::drawn_end_reach * search().size();
        double least = reach;
        const auto consider = [&](const SurfacePoint& a, const SurfacePoint& b) {
            const Vec3 from = position_of(surface_, a), to = position_of(surface_, b);
            if (from == to) return;
            const double share = nearest_share(from, to, at);
            const double distance = (from + share * (to - from) - at).norm();
            if (distance >= least) return;
            least = distance;
            best = share == 0.0 ? a : share == 1.0 ? b : between(a, b, share);
        };
        for (const SurfaceLine& line : found_) {
            for (std::size_t i = 1; i < line.points.size(); ++i)
                consider(line.points[i - 1], line.points[i]);
        }
        for (const auto edge : surface_.mesh.edges()) {
            if (!surface_.mesh.is_boundary(edge)) continue;
            const auto h = surface_.mesh.halfedge_handle(edge, 0);
            consider(SurfacePoint::at_vertex(surface_.mesh.from_vertex_handle(h).idx()),
                     SurfacePoint::at_vertex(surface_.mesh.to_vertex_handle(h).idx()));
        }
        end = best;
        return least < reach;
    }

    const SurfaceMesh& surface_;
    const std::vector<PointSource>& points_;
    std::optional<SurfaceSearch> made_;
    const SurfaceSearch* known_;
    std::vector<SurfaceLine> found_;
    double snap_ = 0.0;                                   ///< of the line at hand
    bool starts_on_line_ = false, ends_on_line_ = false;  ///< likewise
};

}  // namespace

int turn(const CurveForm& form) {
    if (std::holds_alternative<ShortestPath>(form)) return 1;
    const auto* polyline = std::get_if<Polyline>(&form);
    const bool ends = is_drawn(form) && (polyline == nullptr || !is_closed(polyline->points));
    return ends ? 2 : 0;
}

std::vector<SurfaceLine> locate_curves(const SurfaceMesh& surface,
                                       const std::vector<CurveSource>& sources,
                                       const std::vector<PointSource>& points) {
    return Search(surface, points).run(sources);
}

std::vector<SurfaceLine> locate_more_curves(const SurfaceSearch& search, const SurfaceMesh& surface,
                                            const std::vector<SurfaceLine>& before,
                                            const std::vector<CurveSource>& sources,
                                            const std::vector<PointSource>& points) {
    auto lines = Search(surface, points, before, &search).run(sources);
    lines.erase(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(before.size()));
    return lines;
}

}  // namespace lastflat
