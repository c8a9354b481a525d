// One list behind the other.
#pragma once

#include <iterator>
#include <utility>
#include <vector>

namespace lastflat {

template <class Item>
void append(std::vector<Item>& to, std::vector<Item> more) {
    to.insert(to.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

}  // namespace lastflat
