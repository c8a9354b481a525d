// The request of a flattening: the shoe-maker's constraints, as they stand on the wire.
#pragma once

#include <string>
#include <string_view>

#include "core/request.h"

namespace lastflat::api {

struct Field;

/// Lengths in mm; vertex ids from 0, in file order.
struct FlattenRequest {
    Request asked;
    std::string tag;
};

struct RequestLimits {
    std::size_t bytes = 32u << 20;
    int depth = 12;
    std::size_t curves = 256;
    std::size_t curve_vertices = 1'000'000;
    std::size_t regions = 64;
    std::size_t list = 1024;  ///< of any other list
    std::size_t name_bytes = 128;
};

/// Reads the constraint JSON. Absent or empty text: every default.
/// Throws: InvalidRequest naming the field; an unknown field is an error.
[[nodiscard]] FlattenRequest flatten_request_from_json(std::string_view text,
                                                       const RequestLimits& limits = {});
/// The same from a field of a document; pointers begin at that document.
[[nodiscard]] FlattenRequest read_flatten_request(const Field& field, const RequestLimits& limits);

/// A text that is the same for requests that ask the same: of a valid one without its `tag`. A long
/// one stays as it is.
[[nodiscard]] std::string without_tag(const std::string& request);

}  // namespace lastflat::api
