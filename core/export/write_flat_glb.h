// The pattern on the last, as a scene that viewers open.
#pragma once

#include <string>

#include "core/result.h"

namespace lastflat {

/// GLB as viewers expect it: metres, Y up, normals. A node, mesh and primitive for each region,
/// named as it.
///
/// Out:    POSITION and NORMAL on the last, in the model's own axes: the node above the pieces
///         turns them so that Y is up. (Up is from featherline to topline, along the nearest axis;
///         without those curves the model stands as it is.)
///         TEXCOORD_0: 0..1 of the sheet, v downward, so that one picture of the sheet covers all
///         pieces; the sheet's size is in `asset.extras.sheet_mm`.
///         Morph target `flat`: the pieces as they lie on the sheet, on the ground below the last;
///         the animation `flatten` goes there.
[[nodiscard]] std::string write_flat_glb(const FlattenResult& result);

}  // namespace lastflat
