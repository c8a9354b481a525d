// Large bodies of JSON are read by two threads at a time.
#pragma once

#include <cstddef>
#include <semaphore>

namespace lastflat::server {

/// Waits for a turn if the body is large, and has it for as long as it lives. Reading JSON keeps a
/// processor busy, and its values fill memory: large bodies wait for each other, whoever sent them,
/// while small ones and all other requests pass by.
class LargeBodyTurn {
public:
    explicit LargeBodyTurn(std::size_t bytes) : is_large_(bytes > large) {
        if (is_large_) turns().acquire();
    }
    ~LargeBodyTurn() {
        if (is_large_) turns().release();
    }
    LargeBodyTurn(const LargeBodyTurn&) = delete;
    LargeBodyTurn& operator=(const LargeBodyTurn&) = delete;

private:
    static constexpr std::size_t large = 64u << 10;
    static std::counting_semaphore<>& turns() {
        static std::counting_semaphore<> two{2};
        return two;
    }
    const bool is_large_;
};

}  // namespace lastflat::server
