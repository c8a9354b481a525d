// The body of one request, off the socket, within all its bounds.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "server/http/buffer.h"
#include "server/http/chunked_framing.h"
#include "server/http/head.h"
#include "server/http/least_rate.h"
#include "server/http/socket.h"

namespace lastflat::http {

/// What the bodies of all requests that are being served take.
class BodyBytes {
public:
    explicit BodyBytes(std::size_t most) : most_(most) {}
    /// False: there is no room for them; they count all the same until they are given back.
    [[nodiscard]] bool take(std::size_t bytes) { return (total_ += bytes) <= most_; }
    void give_back(std::size_t bytes) { total_ -= bytes; }

private:
    const std::size_t most_;
    std::atomic<std::size_t> total_{0};
};

/// Its bytes count in `all_bodies` as long as it lives.
class BodySource {
public:
    /// The clock starts here. `early`: what arrived together with the head.
    BodySource(int fd, const Head& head, std::string early, const ServerLimits& limits,
               BodyBytes& all_bodies, const StopTime& stop_time);
    ~BodySource() { all_bodies_.give_back(taken_); }
    BodySource(const BodySource&) = delete;
    BodySource& operator=(const BodySource&) = delete;

    /// The whole body without its chunk framing: straight from the socket if its length is known.
    /// Once. Throws: api::Refusal.
    [[nodiscard]] Buffer read();

    /// Whether the body was read to its end.
    [[nodiscard]] bool is_complete() const { return chunked_ ? framing_.complete() : left_ == 0; }
    /// What arrived behind the body: the next request.
    [[nodiscard]] std::string rest() const { return arrived_.substr(used_); }
    /// Chunk framing included.
    [[nodiscard]] std::uint64_t raw_bytes() const { return raw_bytes_; }

private:
    void read_known_length(Buffer& body);
    void read_chunks(Buffer& body);
    [[nodiscard]] std::size_t receive(char* bytes, std::size_t size);
    void take(std::size_t bytes);

    const int fd_;
    const bool chunked_;
    const ServerLimits& limits_;
    BodyBytes& all_bodies_;
    const StopTime& stop_time_;
    const Clock::time_point start_ = Clock::now();
    LeastRate rate_;
    ChunkedFraming framing_;
    std::uint64_t left_;  ///< of a body of known length
    std::uint64_t raw_bytes_ = 0;
    std::size_t taken_ = 0;  ///< of all_bodies_
    std::string arrived_;
    std::size_t used_ = 0;  ///< of arrived_
};

}  // namespace lastflat::http
