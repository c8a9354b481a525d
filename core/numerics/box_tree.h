// Which of many boxes meet one.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/numerics/types.h"

namespace lastflat {

using Box2 = Eigen::AlignedBox2d;
using Box3 = Eigen::AlignedBox3d;

/// A binary tree over boxes in their order: quick where neighbours in the list are neighbours in
/// space, as the edges of a polyline are.
template <class Box>
class BoxTree {
public:
    explicit BoxTree(const std::vector<Box>& boxes) : count_(1) {
        while (count_ < boxes.size()) count_ *= 2;
        nodes_.resize(2 * count_);  // boxes that hold nothing
        for (std::size_t i = 0; i < boxes.size(); ++i) nodes_[count_ + i] = boxes[i];
        for (std::size_t i = count_; i-- > 1;) nodes_[i] = nodes_[2 * i].merged(nodes_[2 * i + 1]);
    }

    /// Calls is_found(i) for the boxes i that meet `box`, ascending, until it returns true.
    template <class IsFound>
    bool find(const Box& box, const IsFound& is_found) const {
        return find_below(1, box, is_found);
    }

private:
    template <class IsFound>
    bool find_below(std::size_t node, const Box& box, const IsFound& is_found) const {
        if (!nodes_[node].intersects(box)) return false;
        if (node >= count_) return is_found(static_cast<Index>(node - count_));
        return find_below(2 * node, box, is_found) || find_below(2 * node + 1, box, is_found);
    }

    std::size_t count_;
    std::vector<Box> nodes_;
};

}  // namespace lastflat
