// STL, text and binary.
#pragma once

#include <string_view>

#include "core/load/load_model.h"

namespace lastflat {

/// Whether the bytes are STL, by their content alone: binary files may begin with "solid" too.
[[nodiscard]] bool is_stl(std::string_view bytes);

/// Reads the triangles of every solid; solids' names are groups, normals are passed over.
///
/// In:     STL bytes. A binary file's count may be 0 or too large: the bytes that are there decide,
///         if they are whole triangles. What follows the triangles of a count is passed over, with
///         the warning `trailing_bytes`. Comments (`#`) may stand before and between solids.
/// Out:    three vertices a triangle, not shared (`indexed` is false): triangle t has the vertices
///         3 t, 3 t + 1, 3 t + 2.
/// Throws: Error{unreadable_model, model_too_large} naming the line or the bytes that are missing.
[[nodiscard]] RawMesh read_stl(std::string_view bytes, const LoadLimits& limits);

}  // namespace lastflat
