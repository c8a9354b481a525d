// A surface is parted where it touches itself.
#pragma once

#include "core/weld/clean_faces.h"

namespace lastflat {

/// A vertex whose faces fall into several fans becomes one vertex for each; the largest fan keeps
/// the id. Of an edge of more than two faces those belong together that bound the same material:
/// sorted by angle around the edge, each one and the next whose outward sides face away from each
/// other [gueziec-2001]. Where that leaves two edges between the same two vertices, a pocket hangs
/// on them, and is parted from the rest. What finds no partner so (one of an odd number, two that
/// wind in opposite directions) gets a border; but where several patches meet at an edge of an odd
/// number of faces, that edge stays one.
void split_fans(Faces& faces);

/// Says which vertices were split, where both parts are still in use.
void list_split_vertices(const Faces& faces, std::vector<Repair>& repairs);

}  // namespace lastflat
