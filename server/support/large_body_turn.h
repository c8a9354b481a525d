// Large bodies of JSON are read by two threads at a time.
#pragma once

#include <cstddef>
#include <string>

#include "server/support/turns.h"

namespace lastflat::server {

/// Waits for a turn if the body is large, and has it for as long as it lives. Reading JSON keeps a
/// processor busy, and its values fill memory: large bodies wait for each other, in turns by owner,
/// while small ones and all other requests pass by.
class LargeBodyTurn {
public:
    LargeBodyTurn(std::string owner, std::size_t bytes)
        : owner_(std::move(owner)),
          has_turn_(bytes > large && turns().enter(owner_, [] { return false; })) {}
    ~LargeBodyTurn() {
        if (has_turn_) turns().leave(owner_);
    }
    LargeBodyTurn(const LargeBodyTurn&) = delete;
    LargeBodyTurn& operator=(const LargeBodyTurn&) = delete;

private:
    static constexpr std::size_t large = 64u << 10;
    static Turns& turns() {
        static Turns two{2};
        return two;
    }
    const std::string owner_;
    const bool has_turn_;
};

}  // namespace lastflat::server
