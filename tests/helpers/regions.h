// The regions that a model is cut into.
#pragma once

#include <string>
#include <vector>

#include "core/cut/cut.h"
#include "core/cut/insert_curves.h"
#include "core/load/load_model.h"
#include "core/locate/curves.h"
#include "core/weld/weld.h"

namespace lastflat::test {

inline std::vector<Region> cut(const std::string& obj, const std::vector<CurveSource>& sources = {},
                               const CutOptions& options = {}) {
    SurfaceMesh surface = weld(load_model(obj));
    const Curves curves = insert_curves(surface, locate_curves(surface, sources)).curves;
    return cut_into_regions(surface, curves, options);
}

}  // namespace lastflat::test
