// Numbers of a glTF accessor, checked against the bytes that are there.
#pragma once

#include <string>
#include <vector>

#include "core/error.h"
#include "core/load/tinygltf.h"

namespace lastflat::gltf {

[[noreturn]] void fail_gltf(const std::string& what, ErrorCode code = ErrorCode::unreadable_model);

template <class List>
const auto& item(const List& list, int index, const char* what) {
    if (index < 0 || static_cast<std::size_t>(index) >= list.size())
        fail_gltf(std::string(what) + " " + std::to_string(index) + " does not exist");
    return list[static_cast<std::size_t>(index)];
}

/// The bytes of a buffer view. Throws: Error{unreadable_model} if it reaches past its buffer.
[[nodiscard]] std::string_view bytes_of(const tinygltf::Model& model, int buffer_view);

class Elements {
public:
    std::size_t count = 0;
    int component_type = 0;

    /// Component i of an element, as the accessor means it (normalised or not).
    [[nodiscard]] double at(std::size_t element, std::size_t i) const;

private:
    friend Elements elements_of(const tinygltf::Model&, int, int, std::size_t);
    std::string_view bytes_;  ///< element e begins at e * stride_
    std::string own_;         ///< the bytes of a sparse accessor, put together
    std::size_t stride_ = 0;
    bool normalized_ = false;
};

/// The elements of an accessor of this type (TINYGLTF_TYPE_...), dense or sparse; at most `most`.
/// Throws: Error{unreadable_model, model_too_large} naming the accessor.
[[nodiscard]] Elements elements_of(const tinygltf::Model& model, int accessor, int type,
                                   std::size_t most);

}  // namespace lastflat::gltf
