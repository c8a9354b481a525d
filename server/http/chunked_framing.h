// Takes the chunks off a chunked body and says where it ends or breaks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "server/http/buffer.h"

namespace lastflat::http {

/// The grammar of RFC 9112, section 7.1, without trailers: no signs, spaces or "0x" in sizes, and
/// every line end is where it should be.
class ChunkedFraming {
public:
    explicit ChunkedFraming(std::uint64_t most_data) : most_data_(most_data) {}

    /// Follows `bytes` up to the end of the body, and appends to `data` what the chunks hold;
    /// returns how many belong to the body and are sound. Fewer than given: see `complete`,
    /// `broken` and `too_large`.
    std::size_t follow(std::string_view bytes, Buffer& data);

    [[nodiscard]] bool complete() const { return state_ == State::complete; }
    [[nodiscard]] bool broken() const { return state_ == State::broken; }
    /// The chunks announce more data than allowed.
    [[nodiscard]] bool too_large() const { return state_ == State::too_large; }

private:
    enum class State {
        size_start,
        size,
        extension,
        size_lf,
        data,
        data_cr,
        data_lf,
        end_cr,
        end_lf,
        complete,
        broken,
        too_large
    };

    [[nodiscard]] State after(char c);
    [[nodiscard]] State after_size_digit(char c);
    [[nodiscard]] State after_size_line();

    State state_ = State::size_start;
    std::uint64_t most_data_;
    std::uint64_t data_ = 0;      ///< announced so far
    std::uint64_t chunk_ = 0;     ///< size of this chunk, then what is left of it
    std::size_t line_bytes_ = 0;  ///< of this size line
};

}  // namespace lastflat::http
