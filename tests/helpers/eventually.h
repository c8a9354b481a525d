// Waiting for what nobody announces.
#pragma once

#include <chrono>
#include <thread>

namespace lastflat::test {

/// How long a test waits for what is sure to come if the code is right.
inline constexpr std::chrono::seconds long_enough{20};

/// Whether the condition comes true within a bounded time. It is polled.
template <class Condition>
[[nodiscard]] bool eventually(const Condition& condition) {
    const auto deadline = std::chrono::steady_clock::now() + long_enough;
    while (!condition()) {
        if (std::chrono::steady_clock::now() > deadline) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
}

}  // namespace lastflat::test
