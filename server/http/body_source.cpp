#include "server/http/body_source.h"

#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "server/http/refusal.h"

namespace lastflat::http {
namespace {

constexpr std::size_t buffer_size = 64u << 10;

/// How many raw bytes a chunked body may have: framing may add a sixteenth, and a small body of
/// tiny chunks more.
std::uint64_t most_raw_bytes(const ServerLimits& limits) {
    return std::uint64_t{limits.body_bytes} + limits.body_bytes / 16 + (1u << 20);
}

}  // namespace

BodySource::BodySource(int fd, const Head& head, std::string early, const ServerLimits& limits,
                       const StopTime& stop_time)
    : fd_(fd),
      chunked_(head.chunked),
      limits_(limits),
      stop_time_(stop_time),
      framing_(limits.body_bytes),
      left_(head.content_length),
      buffer_(std::move(early)) {}

std::size_t BodySource::read(char* bytes, std::size_t size) {
    if (fault_ != Fault::none || at_end() || size == 0) return 0;
    if (used_ == buffer_.size() && !refill()) return 0;
    const std::size_t available = std::min(size, buffer_.size() - used_);
    const std::size_t taken = accept(available, buffer_.data() + used_);
    std::memcpy(bytes, buffer_.data() + used_, taken);
    used_ += taken;
    raw_bytes_ += taken;
    return taken;
}

void BodySource::check_complete() const {
    switch (fault_) {
        case Fault::none: break;
        case Fault::too_slow:
            throw Refusal(408, "body_too_slow",
                          "The body did not arrive in time. Send it faster, or smaller.");
        case Fault::too_large:
            throw Refusal(413, "body_too_large",
                          "The body may have at most " + std::to_string(limits_.body_bytes) +
                              " bytes. Send a smaller model.");
        case Fault::cut_off:
            throw Refusal(400, "body_cut_off",
                          "The connection ended before the body did. Send it again.");
        case Fault::broken_chunks:
            throw Refusal(400, "bad_chunks",
                          "The chunks of the body are broken: each is a hexadecimal size, CR LF, "
                          "the data, CR LF; the last has size 0 and no trailers follow.");
    }
    if (!at_end()) throw Refusal(400, "body_cut_off", "The body could not be read to its end.");
}

bool BodySource::at_end() const {
    return chunked_ ? framing_.complete() : left_ == 0;
}

Clock::time_point BodySource::deadline() const {
    // The time by which the bytes so far would be too few is a deadline like any other.
    const double seconds =
        static_cast<double>(raw_bytes_) /
        static_cast<double>(std::max<std::size_t>(limits_.body_bytes_per_second, 1));
    const double capped = std::min(seconds, 1e6);
    const auto by_rate =
        start_ + limits_.slow_body_grace +
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(capped));
    return std::min(start_ + limits_.body_time, by_rate);
}

bool BodySource::refill() {
    buffer_.resize(buffer_size);
    used_ = 0;
    ssize_t got = 0;
    do {
        if (!wait_for(fd_, SocketEvent::readable, deadline(), stop_time_)) {
            fault_ = Fault::too_slow;
            buffer_.clear();
            return false;
        }
        got = ::recv(fd_, buffer_.data(), buffer_.size(), 0);
    } while (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR));
    buffer_.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    if (got <= 0) fault_ = Fault::cut_off;
    return got > 0;
}

std::size_t BodySource::accept(std::size_t available, const char* bytes) {
    if (!chunked_) {
        const std::size_t taken = std::min<std::uint64_t>(available, left_);
        left_ -= taken;
        return taken;
    }
    const std::size_t taken = framing_.follow({bytes, available});
    if (framing_.broken()) fault_ = Fault::broken_chunks;
    if (framing_.too_large() || raw_bytes_ + taken > most_raw_bytes(limits_)) {
        fault_ = Fault::too_large;
    }
    // With a fault, nothing more may reach the decoder: it would guess.
    return fault_ == Fault::none ? taken : 0;
}

}  // namespace lastflat::http
