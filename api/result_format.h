// The formats of a result.
#pragma once

#include "api/words.h"

namespace lastflat::api {

enum class ResultFormat { json, svg, glb, obj };

inline constexpr Word<ResultFormat> result_formats[] = {{"json", ResultFormat::json},
                                                        {"svg", ResultFormat::svg},
                                                        {"glb", ResultFormat::glb},
                                                        {"obj", ResultFormat::obj}};
/// Of files that hold them.
inline constexpr Word<ResultFormat> result_file_names[] = {{"result.json", ResultFormat::json},
                                                           {"pattern.svg", ResultFormat::svg},
                                                           {"flat.glb", ResultFormat::glb},
                                                           {"flat.obj", ResultFormat::obj}};
/// The one that is preferred first.
inline constexpr Word<ResultFormat> result_media_types[] = {
    {"application/json", ResultFormat::json},
    {"image/svg+xml", ResultFormat::svg},
    {"model/gltf-binary", ResultFormat::glb},
    {"model/obj", ResultFormat::obj}};

}  // namespace lastflat::api
