// tinygltf, which does not build clean under our warnings. It checks structure, not contents: every
// accessor is checked before it is read.
#pragma once

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#include <tiny_gltf.h>
#pragma GCC diagnostic pop
