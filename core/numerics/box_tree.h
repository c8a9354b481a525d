// Which of many boxes in the plane meet one.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/numerics/types.h"

namespace lastflat {

using Box2 = Eigen::AlignedBox2d;

/// A binary tree over boxes in their order: quick where neighbours in the list are neighbours in
/// the plane, as the edges of a polygon are.
class BoxTree {
public:
    explicit BoxTree(const std::vector<Box2>& boxes) : count_(1) {
        while (count_ < boxes.size()) count_ *= 2;
        nodes_.resize(2 * count_);  // boxes that hold nothing
        for (std::size_t i = 0; i < boxes.size(); ++i) nodes_[count_ + i] = boxes[i];
        for (std::size_t i = count_; i-- > 1;) nodes_[i] = nodes_[2 * i].merged(nodes_[2 * i + 1]);
    }

    /// Calls visit(i) for every box i that meets `box`, ascending.
    template <class Visit>
    void for_each_meeting(const Box2& box, const Visit& visit) const {
        descend(1, box, visit);
    }

private:
    template <class Visit>
    void descend(std::size_t node, const Box2& box, const Visit& visit) const {
        if (!nodes_[node].intersects(box)) return;
        if (node >= count_) {
            visit(static_cast<Index>(node - count_));
            return;
        }
        descend(2 * node, box, visit);
        descend(2 * node + 1, box, visit);
    }

    std::size_t count_;
    std::vector<Box2> nodes_;
};

}  // namespace lastflat
