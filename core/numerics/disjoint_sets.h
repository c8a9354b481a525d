// Union-find over 0 .. n-1; the smallest member stands for its set.
#pragma once

#include <numeric>
#include <vector>

#include "core/numerics/types.h"

namespace lastflat {

class DisjointSets {
public:
    explicit DisjointSets(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }
    [[nodiscard]] Index find(Index i) {
        while (parent(i) != i) i = parent(i) = parent(parent(i));
        return i;
    }
    void join(Index a, Index b) {
        a = find(a);
        b = find(b);
        if (a < b)
            parent(b) = a;
        else
            parent(a) = b;
    }

private:
    Index& parent(Index i) { return parent_[static_cast<std::size_t>(i)]; }
    std::vector<Index> parent_;
};

}  // namespace lastflat
