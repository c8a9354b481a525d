// Based on: George, "Nested Dissection of a Regular Finite Element Mesh", SIAM J. Numerical
// Analysis 1973; George, Liu, "An Automatic Nested Dissection Algorithm for Irregular Finite
// Element Problems", SIAM J. Numerical Analysis 1978 (level structures); Heath, Raghavan, "A
// Cartesian Parallel Nested Dissection Algorithm", SIAM J. Matrix Analysis and Applications 1995.
#include "core/numerics/nested_dissection.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <span>

namespace lastflat {
namespace {

/// Blocks of at most this many vertices are dense enough as they are.
constexpr std::size_t leaf_vertices = 12;

class Dissector {
public:
    Dissector(const VertexGraph& graph, const Points2& positions)
        : graph_(graph),
          positions_(positions),
          order_(at(graph.size())),
          side_(at(graph.size()), outside),
          key_(at(graph.size())) {
        for (Index v = 0; v < graph.size(); ++v) order_[at(v)] = v;
    }

    std::vector<EliminationBlock> run() {
        parts_.push_back({0, order_.size(), -1});
        while (!parts_.empty()) {
            const Part part = parts_.back();
            parts_.pop_back();
            if (part.end - part.begin <= leaf_vertices) {
                if (part.end > part.begin) add_block(part);
            } else {
                split(part);
            }
        }
        // Parents were made first; they are to come last.
        std::reverse(blocks_.begin(), blocks_.end());
        const auto last = static_cast<Index>(blocks_.size()) - 1;
        for (auto& block : blocks_) {
            if (block.parent >= 0) block.parent = last - block.parent;
        }
        return std::move(blocks_);
    }

private:
    static constexpr signed char outside = -1;
    struct Part {
        std::size_t begin, end;  ///< in order_
        Index parent;
    };

    Index add_block(const Part& part) {
        blocks_.push_back({part.parent,
                           {order_.begin() + static_cast<std::ptrdiff_t>(part.begin),
                            order_.begin() + static_cast<std::ptrdiff_t>(part.end)}});
        return static_cast<Index>(blocks_.size()) - 1;
    }

    [[nodiscard]] Vec2 longest_direction(std::span<const Index> vertices) const {
        Vec2 mean = Vec2::Zero();
        for (const Index v : vertices) mean += positions_[at(v)];
        mean /= static_cast<double>(vertices.size());
        Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
        for (const Index v : vertices) {
            const Vec2 p = positions_[at(v)] - mean;
            covariance += p * p.transpose();
        }
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen;
        eigen.computeDirect(covariance);
        return eigen.eigenvectors().col(1);
    }

    /// Whether a vertex of `side` has a neighbour on the other side.
    [[nodiscard]] bool faces_across(Index v, signed char side) const {
        for (Index e = graph_.begin[at(v)]; e < graph_.begin[at(v) + 1]; ++e) {
            if (side_[at(graph_.neighbours[at(e)])] == 1 - side) return true;
        }
        return false;
    }

    using Position = std::vector<Index>::iterator;

    /// Sorts a part into its halves by the vertices' keys and marks them.
    void halve(Position begin, Position middle, Position end) {
        std::nth_element(begin, middle, end, [&](Index a, Index b) {
            return std::pair(key_[at(a)], a) < std::pair(key_[at(b)], b);
        });
        for (auto v = begin; v != end; ++v) side_[at(*v)] = v < middle ? 0 : 1;
    }

    /// Of the shorter wall between the halves.
    [[nodiscard]] std::ptrdiff_t wall_length(Position begin, Position middle, Position end) const {
        const auto wall = [&](signed char side) {
            return [this, side](Index v) { return faces_across(v, side); };
        };
        return std::min(std::count_if(begin, middle, wall(0)), std::count_if(middle, end, wall(1)));
    }

    void set_keys(Position begin, Position end, const Vec2& direction) {
        for (auto v = begin; v != end; ++v) key_[at(*v)] = direction.dot(positions_[at(*v)]);
    }

    /// Of a part whose halves are marked: numbers the vertices from one as they are reached from
    /// it; what does not hang together follows. Returns the last.
    Index number_from(Index first, Position begin, Position end) {
        for (auto v = begin; v != end; ++v) key_[at(*v)] = -1.0;
        std::vector<Index> reached;
        const auto reach = [&](Index v) {
            if (side_[at(v)] == outside || key_[at(v)] >= 0.0) return;
            key_[at(v)] = static_cast<double>(reached.size());
            reached.push_back(v);
        };
        reach(first);
        std::size_t next = 0;
        for (auto seed = begin; seed != end; reach(*seed++)) {
            for (; next < reached.size(); ++next) {
                const Index v = reached[next];
                for (Index e = graph_.begin[at(v)]; e < graph_.begin[at(v) + 1]; ++e)
                    reach(graph_.neighbours[at(e)]);
            }
        }
        return reached.back();
    }

    /// Halves a part across its longest direction, or at a slant to it where that leaves a shorter
    /// wall: on regular meshes the walls follow the edges. Where every wall is long, as of a strip
    /// that was wound up, it is halved by the way along its edges.
    void halve_best(Position begin, Position middle, Position end) {
        constexpr std::ptrdiff_t worth_trying = 64;
        constexpr double long_wall = 2.5;  // in units of the square root of all vertices
        const Vec2 longest = longest_direction({begin, end}), across(-longest.y(), longest.x());
        set_keys(begin, end, longest);
        halve(begin, middle, end);
        if (end - begin < worth_trying) return;
        std::ptrdiff_t least = wall_length(begin, middle, end);
        Vec2 best = longest;
        for (const double slant : {0.4, -0.4}) {
            const Vec2 direction = longest + slant * across;
            set_keys(begin, end, direction);
            halve(begin, middle, end);
            const std::ptrdiff_t length = wall_length(begin, middle, end);
            if (length >= least) continue;
            least = length;
            best = direction;
        }
        if (static_cast<double>(least) > long_wall * std::sqrt(static_cast<double>(end - begin))) {
            const Index far = number_from(*std::min_element(begin, end), begin, end);
            number_from(far, begin, end);
            halve(begin, middle, end);
            if (wall_length(begin, middle, end) < least) return;
        }
        set_keys(begin, end, best);
        halve(begin, middle, end);
    }

    void split(const Part& part) {
        const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(part.begin);
        const auto end = order_.begin() + static_cast<std::ptrdiff_t>(part.end);
        const auto middle = begin + (end - begin) / 2;
        halve_best(begin, middle, end);
        const auto inner = [&](signed char side) {
            return [this, side](Index v) { return !faces_across(v, side); };
        };
        const auto low_wall = std::stable_partition(begin, middle, inner(0));
        const auto high_wall = std::stable_partition(middle, end, inner(1));
        for (auto v = begin; v != end; ++v) side_[at(*v)] = outside;
        // The shorter wall separates; it goes to the end of the part.
        auto first_end = middle;
        auto wall = high_wall;
        if (middle - low_wall < end - high_wall) {
            first_end = low_wall;
            wall = std::rotate(low_wall, middle, end);
        }
        const auto index = [&](auto i) { return static_cast<std::size_t>(i - order_.begin()); };
        const Index block =
            wall == end ? part.parent : add_block({index(wall), part.end, part.parent});
        parts_.push_back({part.begin, index(first_end), block});
        parts_.push_back({index(first_end), index(wall), block});
    }

    const VertexGraph& graph_;
    const Points2& positions_;
    std::vector<Index> order_;
    std::vector<signed char> side_;
    std::vector<double> key_;
    std::vector<Part> parts_;
    std::vector<EliminationBlock> blocks_;
};

}  // namespace

VertexGraph vertex_graph(Index vertices, const std::vector<std::pair<Index, Index>>& pairs) {
    std::vector<Index> begin(at(vertices) + 2, 0);
    for (const auto& [v, w] : pairs) {
        ++begin[at(v) + 2];
        ++begin[at(w) + 2];
    }
    for (std::size_t v = 2; v < begin.size(); ++v) begin[v] += begin[v - 1];
    std::vector<Index> neighbours(2 * pairs.size());
    for (const auto& [v, w] : pairs) {
        neighbours[at(begin[at(v) + 1]++)] = w;
        neighbours[at(begin[at(w) + 1]++)] = v;
    }
    VertexGraph graph;
    graph.begin.push_back(0);
    for (std::size_t v = 0; v < at(vertices); ++v) {
        const auto first = neighbours.begin() + begin[v], last = neighbours.begin() + begin[v + 1];
        std::sort(first, last);
        graph.neighbours.insert(graph.neighbours.end(), first, std::unique(first, last));
        graph.begin.push_back(static_cast<Index>(graph.neighbours.size()));
    }
    return graph;
}

std::vector<EliminationBlock> nested_dissection(const VertexGraph& graph,
                                                const Points2& positions) {
    return Dissector(graph, positions).run();
}

}  // namespace lastflat
