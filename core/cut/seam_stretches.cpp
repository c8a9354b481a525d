#include "core/cut/seam_stretches.h"

#include <algorithm>
#include <map>

namespace lastflat {
namespace {

/// An edge of a run: from its vertex `at` to the next.
struct RunEdge {
    std::size_t run, at;
    friend bool operator==(const RunEdge&, const RunEdge&) = default;
};

class Sides {
public:
    Sides(const std::vector<const Region*>& regions, std::string_view curve) : regions_(regions) {
        for (std::size_t r = 0; r < regions.size(); ++r) {
            for (const CurveRun& run : regions[r]->runs) {
                if (run.curve == curve) runs_.push_back({r, &run});
            }
        }
        for (std::size_t k = 0; k < runs_.size(); ++k) {
            for (std::size_t i = 0; i + 1 < vertices(k).size(); ++i)
                edges_[sources({k, i})].push_back({k, i});
        }
    }

    [[nodiscard]] std::vector<SeamStretch> stretches() const {
        std::vector<SeamStretch> found;
        for (std::size_t k = 0; k < runs_.size(); ++k) {
            for (std::size_t i = 0; i + 1 < vertices(k).size();) {
                const std::size_t length = common_length({k, i});
                if (length > 0) found.push_back(stretch({k, i}, length));
                i += std::max<std::size_t>(length, 1);
            }
        }
        return found;
    }

private:
    struct Run {
        std::size_t region;
        const CurveRun* run;
    };

    [[nodiscard]] const std::vector<Index>& vertices(std::size_t run) const {
        return runs_[run].run->vertices;
    }
    [[nodiscard]] std::pair<Index, Index> sources(const RunEdge& edge) const {
        const auto& source = regions_[runs_[edge.run].region]->source_vertices;
        const auto& line = vertices(edge.run);
        return std::minmax(source[static_cast<std::size_t>(line[edge.at])],
                           source[static_cast<std::size_t>(line[edge.at + 1])]);
    }
    /// The edge on the other side, if there is one; each two are seen from the first alone.
    [[nodiscard]] const RunEdge* partner(const RunEdge& edge) const {
        const auto& both = edges_.at(sources(edge));
        return both.size() == 2 && both.front() == edge ? &both.back() : nullptr;
    }
    /// How many edges from this one on have the edges of one run on their other side.
    [[nodiscard]] std::size_t common_length(RunEdge edge) const {
        const RunEdge* first = partner(edge);
        if (first == nullptr) return 0;
        RunEdge other = *first;
        for (std::size_t length = 1;; ++length) {
            if (++edge.at + 1 >= vertices(edge.run).size()) return length;
            const RunEdge* next = partner(edge);
            ++other.at;
            if (next == nullptr || *next != other) return length;
        }
    }
    [[nodiscard]] SeamStretch stretch(const RunEdge& from, std::size_t length) const {
        const auto side = [&](const RunEdge& edge) {
            const auto begin = vertices(edge.run).begin() + static_cast<std::ptrdiff_t>(edge.at);
            return SeamStretch::Side{runs_[edge.run].region,
                                     {begin, begin + static_cast<std::ptrdiff_t>(length) + 1}};
        };
        return {side(from), side(*partner(from))};
    }

    const std::vector<const Region*>& regions_;
    std::vector<Run> runs_;
    std::map<std::pair<Index, Index>, std::vector<RunEdge>> edges_;  ///< by their sources
};

}  // namespace

std::vector<SeamStretch> seam_stretches(const std::vector<const Region*>& regions,
                                        std::string_view curve) {
    return Sides(regions, curve).stretches();
}

}  // namespace lastflat
