// The raw bytes of one request's body, as they come off the socket, within all its bounds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "server/http/chunked_framing.h"
#include "server/http/head.h"
#include "server/http/socket.h"

namespace lastflat::http {

class BodySource {
public:
    /// The clock starts here. `early`: what arrived together with the head.
    BodySource(int fd, const Head& head, std::string early, const ServerLimits& limits,
               const StopTime& stop_time);

    /// At most `size` bytes, chunk framing included; 0 at the end of the body and after any fault.
    [[nodiscard]] std::size_t read(char* bytes, std::size_t size);

    /// Whether the body was read to its end.
    [[nodiscard]] bool is_complete() const { return fault_ == Fault::none && at_end(); }
    /// What arrived behind the body: the next request.
    [[nodiscard]] std::string rest() const { return buffer_.substr(used_); }
    [[nodiscard]] std::uint64_t raw_bytes() const { return raw_bytes_; }

    /// Throws: Refusal if the body was not read to its end, saying why.
    void check_complete() const;

private:
    enum class Fault { none, too_slow, too_large, cut_off, broken_chunks };

    [[nodiscard]] bool at_end() const;
    [[nodiscard]] bool refill();
    [[nodiscard]] Clock::time_point deadline() const;
    [[nodiscard]] std::size_t accept(std::size_t available, const char* bytes);

    const int fd_;
    const bool chunked_;
    const ServerLimits& limits_;
    const StopTime& stop_time_;
    const Clock::time_point start_ = Clock::now();
    ChunkedFraming framing_;
    std::uint64_t left_;  ///< of a body of known length
    std::uint64_t raw_bytes_ = 0;
    std::string buffer_;
    std::size_t used_ = 0;  ///< of buffer_
    Fault fault_ = Fault::none;
};

}  // namespace lastflat::http
