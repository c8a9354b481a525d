// Numbers from bytes, whatever the machine's own order.
#pragma once

#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>

namespace lastflat {

enum class ByteOrder { little, big };

/// `bytes` has at least sizeof(T).
template <class T>
[[nodiscard]] T read_unsigned(std::string_view bytes, ByteOrder order) {
    static_assert(std::is_unsigned_v<T>);
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) {
        const std::size_t at = order == ByteOrder::big ? i : sizeof(T) - 1 - i;
        value = value << 8 | static_cast<unsigned char>(bytes[at]);
    }
    return static_cast<T>(value);
}

/// IEEE 754. `bytes` has at least sizeof(T).
template <class T>
[[nodiscard]] T read_float(std::string_view bytes, ByteOrder order) {
    using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
    const Bits bits = read_unsigned<Bits>(bytes, order);
    T value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

}  // namespace lastflat
