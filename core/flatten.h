// The whole method: a model's bytes in, flat pieces and their certificate out.
#pragma once

#include <string_view>

#include "core/progress.h"
#include "core/request.h"
#include "core/result.h"

namespace lastflat {

/// Flattens a last.
///
/// In:     the bytes of a model (see `load_model`), the shoe-maker's constraints.
/// Out:    every chosen region, flat; no triangle flipped; with `isometric` every constraint kept
///         to `tolerance::locked_length` and no border that crosses itself. The same bytes and
///         options give the same result but for its `timing`, whatever `threads` is.
/// Throws: Error, of any code; nothing is returned in part.
[[nodiscard]] FlattenResult flatten(std::string_view model, const FlattenOptions& options,
                                    Progress& progress);

}  // namespace lastflat
