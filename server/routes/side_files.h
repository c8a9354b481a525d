// Files that a model refers to by name, sent beside it.
#pragma once

#include <vector>

#include "server/http/http.h"

namespace lastflat::server {

/// A glTF document with the named buffers put inside as data URIs, so that it is one file.
///
/// In:     the document; the parts, each with the file name that a buffer's `uri` has; who sends
/// it. Throws: api::Refusal if the model is no glTF document, a buffer of it has no part, or a part
///         belongs to no buffer; api::InvalidRequest if the document cannot be read.
[[nodiscard]] std::string with_buffers_inside(std::string_view gltf,
                                              const std::vector<const http::BodyPart*>& buffers,
                                              const std::string& owner);

}  // namespace lastflat::server
