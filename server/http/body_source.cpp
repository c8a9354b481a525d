#include "server/http/body_source.h"

#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "server/http/refusal.h"

namespace lastflat::http {
namespace {

constexpr std::size_t body_step = 64u << 10;

/// How many raw bytes a chunked body may have: framing may add a sixteenth, and a small body of
/// tiny chunks more.
std::uint64_t most_raw_bytes(const ServerLimits& limits) {
    return std::uint64_t{limits.body_bytes} + limits.body_bytes / 16 + (1u << 20);
}

}  // namespace

BodySource::BodySource(int fd, const Head& head, std::string early, const ServerLimits& limits,
                       BodyBytes& all_bodies, const StopTime& stop_time)
    : fd_(fd),
      chunked_(head.chunked),
      limits_(limits),
      all_bodies_(all_bodies),
      stop_time_(stop_time),
      rate_(limits),
      framing_(limits.body_bytes),
      left_(head.content_length),
      arrived_(std::move(early)) {}

Buffer BodySource::read() {
    Buffer body;
    if (chunked_)
        read_chunks(body);
    else
        read_known_length(body);
    return body;
}

void BodySource::read_known_length(Buffer& body) {
    used_ = std::min<std::uint64_t>(arrived_.size(), left_);
    body.append(std::string_view(arrived_).substr(0, used_));
    std::size_t got = used_;
    while (true) {
        raw_bytes_ += got;
        left_ -= got;
        take(got);
        if (left_ == 0) return;
        const std::size_t step = std::min<std::uint64_t>(left_, body_step);
        got = receive(body.end_with_room(step), step);
        body.add(got);
    }
}

void BodySource::read_chunks(Buffer& body) {
    while (true) {
        const std::size_t before = body.size();
        const std::size_t sound = framing_.follow(std::string_view(arrived_).substr(used_), body);
        used_ += sound;
        raw_bytes_ += sound;
        take(body.size() - before);
        if (framing_.too_large() || raw_bytes_ > most_raw_bytes(limits_)) {
            throw api::Refusal("body_too_large", "The body may have at most " +
                                                     std::to_string(limits_.body_bytes) +
                                                     " bytes. Send a smaller model.");
        }
        if (framing_.broken()) {
            throw api::Refusal(
                "bad_chunks",
                "The chunks of the body are broken: each is a hexadecimal size, CR LF, "
                "the data, CR LF; the last has size 0 and no trailers follow.");
        }
        if (framing_.complete()) return;
        arrived_.resize(body_step);
        used_ = 0;
        arrived_.resize(receive(arrived_.data(), arrived_.size()));
    }
}

/// At least one byte.
std::size_t BodySource::receive(char* bytes, std::size_t size) {
    ssize_t got = 0;
    do {
        const auto deadline = std::min(start_ + limits_.body_time, rate_.deadline());
        if (!wait_for(fd_, SocketEvent::readable, deadline, stop_time_)) {
            throw api::Refusal("body_too_slow",
                               "The body did not arrive in time. Send it faster, or smaller.");
        }
        got = ::recv(fd_, bytes, size, 0);
    } while (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR));
    if (got <= 0) {
        throw api::Refusal("body_cut_off",
                           "The connection ended before the body did. Send it again.");
    }
    rate_.note(static_cast<std::size_t>(got));
    return static_cast<std::size_t>(got);
}

void BodySource::take(std::size_t bytes) {
    taken_ += bytes;
    if (!all_bodies_.take(bytes)) throw overloaded();
}

}  // namespace lastflat::http
