#include "server/http/chunked_framing.h"

#include <algorithm>

namespace lastflat::http {
namespace {

/// Size lines longer than this are refused, extensions included.
constexpr std::size_t longest_size_line = 256;
/// Enough for any size that could be allowed, and far from overflow.
constexpr std::uint64_t largest_chunk = std::uint64_t{1} << 48;

int hex_value(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

}  // namespace

std::size_t ChunkedFraming::follow(std::string_view bytes, Buffer& data) {
    std::size_t at = 0;
    while (at < bytes.size()) {
        if (complete() || broken() || too_large()) break;
        if (state_ == State::data) {
            const std::size_t step = std::min<std::uint64_t>(chunk_, bytes.size() - at);
            data.append(bytes.substr(at, step));
            chunk_ -= step;
            at += step;
            if (chunk_ == 0) state_ = State::data_cr;
            continue;
        }
        state_ = after(bytes[at]);
        if (broken() || too_large()) break;
        ++at;
    }
    return at;
}

ChunkedFraming::State ChunkedFraming::after(char c) {
    const auto only = [c](char wanted, State next) { return c == wanted ? next : State::broken; };
    switch (state_) {
        case State::size_start:
            line_bytes_ = 0;
            chunk_ = 0;
            return after_size_digit(c);
        case State::size:
            if (c == '\r') return State::size_lf;
            if (c == ';') return State::extension;
            return after_size_digit(c);
        case State::extension:
            if (c == '\r') return State::size_lf;
            if (++line_bytes_ > longest_size_line) return State::broken;
            return static_cast<unsigned char>(c) < 0x20 || c == 0x7F ? State::broken
                                                                     : State::extension;
        case State::size_lf: return c == '\n' ? after_size_line() : State::broken;
        case State::data_cr: return only('\r', State::data_lf);
        case State::data_lf: return only('\n', State::size_start);
        case State::end_cr: return only('\r', State::end_lf);
        case State::end_lf: return only('\n', State::complete);
        case State::data:
        case State::complete:
        case State::broken:
        case State::too_large: break;
    }
    return state_;
}

ChunkedFraming::State ChunkedFraming::after_size_digit(char c) {
    const int value = hex_value(c);
    chunk_ = chunk_ * 16 + static_cast<std::uint64_t>(std::max(value, 0));
    if (value < 0 || ++line_bytes_ > longest_size_line) return State::broken;
    return chunk_ > largest_chunk ? State::too_large : State::size;
}

ChunkedFraming::State ChunkedFraming::after_size_line() {
    if (chunk_ == 0) return State::end_cr;
    data_ += chunk_;
    return data_ > most_data_ ? State::too_large : State::data;
}

}  // namespace lastflat::http
