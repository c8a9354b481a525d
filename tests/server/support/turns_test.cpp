#include "server/support/turns.h"

#include <doctest/doctest.h>

#include <thread>
#include <vector>

#include "tests/helpers/eventually.h"

namespace lastflat::server {
namespace {

/// Those who wait, in the order in which they were served.
class Queue {
public:
    explicit Queue(Turns& turns) : turns_(turns) {}
    ~Queue() {
        for (std::thread& thread : threads_) thread.join();
    }
    /// Returns once it waits.
    void join(const std::string& owner) {
        std::atomic<bool> waits{false};
        threads_.emplace_back([&, owner] {
            const bool served = turns_.enter(owner, [&] {
                waits = true;
                return false;
            });
            const std::scoped_lock lock(mutex_);
            if (served) order_ += owner;
            turns_.leave(owner);
        });
        REQUIRE(lastflat::test::eventually([&] { return waits.load(); }));
    }
    std::string order() {
        for (std::thread& thread : threads_) thread.join();
        threads_.clear();
        return order_;
    }

private:
    Turns& turns_;
    std::mutex mutex_;
    std::string order_;
    std::vector<std::thread> threads_;
};

const auto never = [] { return false; };

}  // namespace

TEST_SUITE("server/support/turns") {
    TEST_CASE("a free place is had at once, a taken one when it is free again") {
        Turns turns(2);
        REQUIRE(turns.enter("a", never));
        REQUIRE(turns.enter("a", never));
        CHECK_FALSE(turns.enter("a", [] { return true; }));
        turns.leave("a");
        CHECK(turns.enter("b", never));
    }

    TEST_CASE("who has waited in one's own queue does not wait in that of another") {
        Turns turns(1);
        REQUIRE(turns.enter("a", never));
        Queue queue(turns);
        for (const char* owner : {"a", "a", "a", "b", "b", "c"}) queue.join(owner);
        turns.leave("a");
        CHECK(queue.order() == "bcabaa");
    }
}

}  // namespace lastflat::server
