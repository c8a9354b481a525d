// The surface, opened along curves, falls into regions.
#pragma once

#include "core/cut/insert_curves.h"
#include "core/cut/open_holes.h"
#include "core/cut/region.h"
#include "core/request.h"

namespace lastflat {

/// Opens the surface along cuts and seams and returns the chosen pieces in the order of `regions`
/// (or of their smallest face). Every vertex of a cut becomes one vertex per side.
///
/// Out:    regions that are disks, or disks with holes.
/// Throws: Error{curve_invalid} for a cut that names no curve; Error{region_invalid} if a choice
///         fits no piece, lies on a cut, or is taken twice; Error{region_not_disk} saying what the
///         piece is instead ("closed", "genus 1").
[[nodiscard]] std::vector<Region> cut_into_regions(const SurfaceMesh& surface, const Curves& curves,
                                                   const CutOptions& options);

}  // namespace lastflat
