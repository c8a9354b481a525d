#include "core/weld/stitch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "core/numerics/box_tree.h"
#include "core/numerics/geometry.h"
#include "core/numerics/tolerances.h"
#include "core/text.h"
#include "core/weld/borders.h"
#include "core/weld/join_borders.h"
#include "core/weld/merge_vertices.h"
#include "core/weld/sides.h"

namespace lastflat {
namespace {

/// The nearest point of one loop.
struct Foot {
    std::size_t edge;  ///< from this vertex of the loop to the next
    double along;
    Vec3 position;
};

class LoopSearch {
public:
    LoopSearch(const Faces& faces, const Loop& loop)
        : faces_(faces), loop_(loop), tree_(boxes_of(faces, loop)) {}

    [[nodiscard]] std::optional<Foot> nearest(const Vec3& position, double reach) const {
        std::optional<Foot> best;
        double least = reach;
        const Box3 box(position - Vec3::Constant(reach), position + Vec3::Constant(reach));
        tree_.find(box, [&](Index i) {
            const auto edge = static_cast<std::size_t>(i);
            const Vec3& a = faces_.position(loop_.vertex(edge));
            const Vec3 way = faces_.position(loop_.vertex(edge + 1)) - a;
            const double share =
                nearest_share(a, faces_.position(loop_.vertex(edge + 1)), position);
            const Vec3 foot = a + share * way;
            if ((foot - position).norm() <= least) {
                least = (foot - position).norm();
                best = Foot{edge, loop_.along[edge] + share * way.norm(), foot};
            }
            return false;
        });
        return best;
    }

private:
    static std::vector<Box3> boxes_of(const Faces& faces, const Loop& loop) {
        std::vector<Box3> boxes;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            Box3 box(faces.position(loop.vertex(i)));
            boxes.push_back(box.extend(faces.position(loop.vertex(i + 1))));
        }
        return boxes;
    }
    const Faces& faces_;
    const Loop& loop_;
    BoxTree<Box3> tree_;
};

/// One vertex on the common line of two loops: of a, of b, or one of each that become one.
struct Bead {
    double at;  ///< along the common line
    Index a, b;
    Vec3 position;  ///< where it comes to lie
    [[nodiscard]] bool joins() const { return a >= 0 && b >= 0; }
};

/// Two closed loops that run along each other all the way become one line of edges, halfway
/// between them; each gets the other's vertices, in one order.
class Zipper {
public:
    Zipper(Faces& faces, const Loop& a, const Loop& b) : faces_(faces), a_(a), b_(b) {}

    /// Whether every vertex of each is within reach of the other, and they run once around.
    [[nodiscard]] bool fits(double reach) {
        const LoopSearch on_b(faces_, b_), on_a(faces_, a_);
        for (std::size_t j = 0; j < b_.size(); ++j) {
            const auto foot = on_a.nearest(faces_.position(b_.vertex(j)), reach);
            if (!foot) return false;
            feet_of_b_.push_back(*foot);
        }
        double at = 0.0, last = 0.0;
        for (std::size_t i = 0; i < a_.size(); ++i) {
            const auto foot = on_b.nearest(faces_.position(a_.vertex(i)), reach);
            if (!foot) return false;
            feet_of_a_.push_back(*foot);
            double step = foot->along - last;
            step -= b_.length * std::round(step / b_.length);
            if (i > 0) at += step;
            last = foot->along;
            along_of_a_.push_back(at);
        }
        double step = feet_of_a_.front().along - last;
        step -= b_.length * std::round(step / b_.length);
        turns_ = (at + step) / b_.length;
        return std::abs(std::abs(turns_) - 1.0) < tolerance::alike_turns;
    }

    /// How far the furthest vertex was moved.
    double close(RepairNote& joined, RepairNote& inserted) {
        const std::vector<Bead> beads = line();
        Insertions insertions;
        double furthest = 0.0;
        insert_between(beads, true, insertions);
        insert_between(beads, false, insertions);
        insert_into_edges(faces_, insertions);
        std::map<Index, Index> renamed;
        for (const Bead& bead : beads) {
            const Index stays = bead.joins() ? std::min(bead.a, bead.b) : std::max(bead.a, bead.b);
            if (bead.joins()) renamed[std::max(bead.a, bead.b)] = stays;
            Vec3& position = faces_.positions[static_cast<std::size_t>(stays)];
            furthest = std::max(furthest, (position - bead.position).norm());
            position = bead.position;
            (bead.joins() ? joined : inserted).at(position);
        }
        rename_vertices(faces_, renamed);
        return furthest;
    }

private:
    /// The vertices of both loops in the order of the common line, which begins at a's first.
    [[nodiscard]] std::vector<Bead> line() const {
        const double sign = turns_ < 0.0 ? -1.0 : 1.0;
        std::vector<Bead> beads;
        for (std::size_t i = 0; i < a_.size(); ++i) {
            // Where the nearest points run backwards for a while, the order along a counts.
            const double before = beads.empty() ? 0.0 : beads.back().at;
            const Vec3 middle = 0.5 * (faces_.position(a_.vertex(i)) + feet_of_a_[i].position);
            beads.push_back({std::min(std::max(before, sign * along_of_a_[i]), b_.length),
                             a_.vertex(i), -1, middle});
        }
        const std::size_t count = beads.size();
        const double first = feet_of_a_.front().along;
        for (std::size_t j = 0; j < b_.size(); ++j) {
            double at = sign * (b_.along[j] - first);
            at -= b_.length * std::floor(at / b_.length);
            const Vec3 middle = 0.5 * (faces_.position(b_.vertex(j)) + feet_of_b_[j].position);
            if (Bead* near = partner(beads, count, at, j)) {
                near->b = b_.vertex(j);
            } else {
                beads.push_back({at, -1, b_.vertex(j), middle});
            }
        }
        std::stable_sort(beads.begin(), beads.end(),
                         [](const Bead& x, const Bead& y) { return x.at < y.at; });
        return beads;
    }

    /// The free vertex of a that is so near along the line that a triangle between them would be a
    /// needle.
    [[nodiscard]] Bead* partner(std::vector<Bead>& beads, std::size_t count, double at,
                                std::size_t j) const {
        const double before =
            (faces_.position(b_.vertex(j)) - faces_.position(b_.vertex(j + b_.size() - 1))).norm();
        const double after =
            (faces_.position(b_.vertex(j + 1)) - faces_.position(b_.vertex(j))).norm();
        Bead* best = nullptr;
        double least = tolerance::needle * std::min(before, after);
        const auto after_it =
            std::lower_bound(beads.begin(), beads.begin() + static_cast<std::ptrdiff_t>(count), at,
                             [](const Bead& bead, double along) { return bead.at < along; });
        const auto middle = static_cast<std::size_t>(after_it - beads.begin());
        for (std::size_t k = middle + count - 2; k < middle + count + 2; ++k) {
            const std::size_t i = k % count;
            const double apart = std::abs(beads[i].at - at);
            const double way = std::min(apart, b_.length - apart);
            if (way > least || beads[i].joins()) continue;
            const Bead &left = beads[(i + count - 1) % count], &right = beads[(i + 1) % count];
            const double own = std::min(
                (faces_.position(a_.vertex(i)) - faces_.position(a_.vertex(i + count - 1))).norm(),
                (faces_.position(a_.vertex(i + 1)) - faces_.position(a_.vertex(i))).norm());
            if (way > tolerance::needle * own || left.at == beads[i].at || right.at == beads[i].at)
                continue;
            least = way;
            best = &beads[i];
        }
        return best;
    }

    /// For every edge of one loop the vertices of the other that come between its ends.
    void insert_between(const std::vector<Bead>& beads, bool of_a, Insertions& insertions) const {
        const std::size_t count = beads.size();
        const auto own = [&](const Bead& bead) { return (of_a ? bead.a : bead.b) >= 0; };
        const auto name = [&](const Bead& bead) { return of_a ? bead.a : bead.b; };
        std::size_t begin = 0;
        while (!own(beads[begin])) ++begin;
        Index from = name(beads[begin]);
        std::vector<Index> between;
        for (std::size_t k = 1; k <= count; ++k) {
            const Bead& bead = beads[(begin + k) % count];
            if (!own(bead)) {
                between.push_back(std::max(bead.a, bead.b));
                continue;
            }
            const Index to = name(bead);
            if (!between.empty()) {
                const bool forward = of_a || turns_ > 0.0;  // the line runs as a does
                if (!forward) std::reverse(between.begin(), between.end());
                insertions[forward ? std::pair(from, to) : std::pair(to, from)] = between;
                between.clear();
            }
            from = to;
        }
    }

    Faces& faces_;
    const Loop &a_, &b_;
    std::vector<Foot> feet_of_a_, feet_of_b_;
    std::vector<double> along_of_a_;
    double turns_ = 0.0;
};

/// Border vertices of one and the same position become one: seams within a patch.
void join_same_positions(Faces& faces, double tolerance, RepairNote& note) {
    std::vector<Index> vertices;
    Points3 positions;
    for (const Loop& loop : border_loops(faces)) {
        for (const Index v : loop.vertices) {
            vertices.push_back(v);
            positions.push_back(faces.position(v));
        }
    }
    const std::vector<Index> same = merge_vertices(positions, tolerance);
    std::map<Index, Index> renamed;
    for (std::size_t i = 0; i < same.size(); ++i) {
        const Index stays = vertices[static_cast<std::size_t>(same[i])];
        if (stays == vertices[i]) continue;
        note.at(positions[i]);
        renamed[vertices[i]] = stays;
    }
    rename_vertices(faces, renamed);
}

/// Whether two loops were found that fit, and were closed.
bool zip_one_pair(Faces& faces, double tolerance, double& furthest, RepairNote& joined,
                  RepairNote& inserted) {
    const auto loops = border_loops(faces);
    for (std::size_t i = 0; i < loops.size(); ++i) {
        for (std::size_t j = i + 1; j < loops.size(); ++j) {
            if (std::abs(loops[i].length - loops[j].length) >
                tolerance::alike_length * loops[i].length)
                continue;
            Zipper zipper(faces, loops[i], loops[j]);
            if (!zipper.fits(tolerance)) continue;
            furthest = std::max(furthest, zipper.close(joined, inserted));
            return true;
        }
    }
    return false;
}

/// What a border vertex lies on, but for the ends of edges.
Insertions vertices_on_edges(const Faces& faces, double tolerance) {
    std::vector<Side> border;
    for_each_edge(faces.sides(), [&](auto first, auto last) {
        if (last - first == 1) border.push_back(*first);
    });
    std::vector<Box3> boxes;
    for (const Side& side : border) {
        Box3 box(faces.position(side.low));
        boxes.push_back(box.extend(faces.position(side.high)));
    }
    const BoxTree<Box3> tree(boxes);
    std::map<std::pair<Index, Index>, std::vector<std::pair<double, Index>>> found;
    for (const Side& side : border) {
        const Index v = side.from();
        const Vec3& at = faces.position(v);
        const Box3 box(at - Vec3::Constant(tolerance), at + Vec3::Constant(tolerance));
        tree.find(box, [&](Index i) {
            const Side& edge = border[static_cast<std::size_t>(i)];
            const Vec3& a = faces.position(edge.from());
            const Vec3 way = faces.position(edge.to()) - a;
            const double along = way.dot(at - a) / way.norm();
            const bool inside = along > 2.0 * tolerance && along < way.norm() - 2.0 * tolerance;
            if (v != edge.from() && v != edge.to() && inside &&
                (a + along * way.normalized() - at).norm() <= tolerance)
                found[{edge.from(), edge.to()}].emplace_back(along, v);
            return false;
        });
    }
    Insertions insertions;
    for (auto& [edge, vertices] : found) {
        std::sort(vertices.begin(), vertices.end());
        for (const auto& [along, v] : vertices) {
            if (insertions[edge].empty() || insertions[edge].back() != v)
                insertions[edge].push_back(v);
        }
    }
    return insertions;
}

}  // namespace

void close_t_junctions(Faces& faces, double tolerance_mm, std::vector<Repair>& repairs) {
    Insertions insertions = vertices_on_edges(faces, tolerance_mm);
    if (insertions.empty()) return;
    RepairNote same, note;  // the ends of an edge that was met are met, too
    join_same_positions(faces, tolerance_mm, same);
    insertions = vertices_on_edges(faces, tolerance_mm);
    for (const auto& [edge, vertices] : insertions) {
        for (const Index v : vertices) note.at(faces.position(v));
    }
    insert_into_edges(faces, insertions);
    note.write(repairs, "t_junctions_closed", "vertices were put into the edges that they lay on");
}

void stitch(Faces& faces, double tolerance_mm, std::vector<Repair>& repairs) {
    RepairNote same, joined, inserted;
    double furthest = 0.0;
    constexpr int most_seams = 64;
    join_same_positions(faces, tolerance::same_border_vertex * tolerance_mm, same);
    for (int seam = 0; seam < most_seams; ++seam) {
        if (!zip_one_pair(faces, tolerance_mm, furthest, joined, inserted)) break;
    }
    furthest = std::max(furthest, join_borders(faces, tolerance_mm, joined, inserted));
    const std::string moved = "; nothing was moved by more than " + fixed_text(furthest, 3) + " mm";
    same.write(repairs, "borders_welded", "border vertices of the same place were joined");
    joined.write(repairs, "gaps_closed", "pairs of vertices across gaps were joined" + moved);
    inserted.write(repairs, "t_junctions_closed",
                   "vertices were put into edges across gaps" + moved);
}

}  // namespace lastflat
