// Independent work on several threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>
#include <vector>

namespace lastflat {

/// Calls work(0) .. work(count - 1), at most `threads` at once. If calls throw, the exception of
/// the lowest index is rethrown after all have ended: the outcome does not depend on timing.
template <class Work>
void for_each_index(std::size_t count, std::size_t threads, const Work& work) {
    std::vector<std::exception_ptr> failures(count);
    std::atomic<std::size_t> next{0};
    const auto run = [&] {
        for (std::size_t i = next++; i < count; i = next++) {
            try {
                work(i);
            } catch (...) {
                failures[i] = std::current_exception();
            }
        }
    };
    {
        std::vector<std::jthread> helpers;
        for (std::size_t i = 1; i < std::min(threads, count); ++i) helpers.emplace_back(run);
        run();
    }
    for (const auto& failure : failures) {
        if (failure) std::rethrow_exception(failure);
    }
}

}  // namespace lastflat
