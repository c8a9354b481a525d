// What has to be done at the end of a scope, however it ends.
#pragma once

#include <utility>

namespace lastflat::server {

/// `const ScopeExit at_end([&] { ... });` The work must not throw.
template <class Work>
class ScopeExit {
public:
    explicit ScopeExit(Work work) : work_(std::move(work)) {}
    ~ScopeExit() { work_(); }
    ScopeExit(const ScopeExit&) = delete;
    ScopeExit& operator=(const ScopeExit&) = delete;

private:
    const Work work_;
};

}  // namespace lastflat::server
