// The bytes of a body on their way in.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <string_view>

namespace lastflat::http {

/// Bytes that grow without being copied: the C library moves a large block by its pages, and what
/// is reserved costs nothing until it is written. So a body never takes twice its size, as it would
/// in a string.
class Buffer {
public:
    [[nodiscard]] std::string_view view() const { return {bytes_.get(), size_}; }
    [[nodiscard]] std::size_t size() const { return size_; }

    /// Where `room` more bytes can be written; `add` counts those that were.
    /// Throws: std::bad_alloc.
    [[nodiscard]] char* end_with_room(std::size_t room);
    void add(std::size_t written) { size_ += written; }
    void append(std::string_view bytes);

private:
    struct Free {
        void operator()(char* bytes) const { std::free(bytes); }
    };
    std::unique_ptr<char, Free> bytes_;
    std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace lastflat::http
