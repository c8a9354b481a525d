#pragma once

namespace lastflat {

/// One visitor of a variant from a function for each of its kinds.
template <class... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

}  // namespace lastflat
