#include "server/http/buffer.h"

#include <algorithm>
#include <cstring>
#include <new>

namespace lastflat::http {

char* Buffer::end_with_room(std::size_t room) {
    if (capacity_ - size_ < room) {
        const std::size_t capacity = std::max(size_ + room, 2 * capacity_);
        auto* moved = static_cast<char*>(std::realloc(bytes_.get(), capacity));
        if (moved == nullptr) throw std::bad_alloc();
        (void)bytes_.release();
        bytes_.reset(moved);
        capacity_ = capacity;
    }
    return bytes_.get() + size_;
}

void Buffer::append(std::string_view bytes) {
    if (bytes.empty()) return;
    std::memcpy(end_with_room(bytes.size()), bytes.data(), bytes.size());
    add(bytes.size());
}

}  // namespace lastflat::http
