// What a look at the first bytes tells of a model.
#pragma once

#include <string_view>

namespace lastflat {

/// Takes no longer for a large model than for a small one. What passes may still be no model.
/// Throws: Error{unsupported_model} for a known format that is not read, Error{unreadable_model}
/// for what is none: a web page, zeros, a header that is cut off.
void check_first_bytes(std::string_view bytes);

}  // namespace lastflat
