// The binary glTF container: a JSON document and the buffer it describes.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/numerics/types.h"

namespace lastflat {

/// Collects accessors into one buffer and writes the container.
class GlbContainer {
public:
    GlbContainer();

    /// VEC3 of floats with bounds; returns the accessor.
    std::size_t add_positions(const Points3& points);
    /// VEC3 of floats without bounds; returns the accessor.
    std::size_t add_directions(const Points3& vectors);
    /// Floats with bounds, which no vertex has; returns the accessor.
    std::size_t add_scalars(const std::vector<double>& values);
    /// VEC2 of floats; returns the accessor.
    std::size_t add_texture_coordinates(const Points2& points);
    /// SCALAR of unsigned 32 bit; returns the accessor.
    std::size_t add_indices(const std::vector<Triangle>& triangles);
    /// The same of ids that no primitive uses.
    std::size_t add_ids(const std::vector<Index>& ids);

    [[nodiscard]] nlohmann::ordered_json& document() { return document_; }
    [[nodiscard]] std::string write() const;

private:
    std::size_t add_accessor(const char* type, int component_type, std::size_t count,
                             std::size_t bytes, int target);
    void append_floats(const Points3& vectors);

    nlohmann::ordered_json document_;
    std::string buffer_;
};

}  // namespace lastflat
