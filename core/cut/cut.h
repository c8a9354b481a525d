// The surface, opened along curves, falls into regions.
#pragma once

#include "core/cut/insert_curves.h"
#include "core/cut/region.h"

namespace lastflat {

/// Which of the pieces is meant by a region's name.
struct RegionChoice {
    std::string name;
    std::optional<Index> vertex;   ///< an id of the file inside the region
    std::optional<Vec3> position;  ///< or a place; its nearest vertex is meant, mm
};

struct CutOptions {
    std::vector<std::string> cuts;      ///< names of curves
    std::vector<RegionChoice> regions;  ///< empty: every piece is a region
};

/// Opens the surface along the cuts and returns the chosen pieces in the order of `regions` (or of
/// their smallest face). Every vertex of a cut becomes one vertex per side.
///
/// Out:    regions that are disks: one border loop, no handle.
/// Throws: Error{curve_invalid} for a cut that names no curve; Error{region_invalid} if a choice
///         fits no piece, lies on a cut, or is taken twice; Error{region_not_disk} saying what the
///         piece is instead ("2 border loops", "genus 1").
[[nodiscard]] std::vector<Region> cut_into_regions(const SurfaceMesh& surface, const Curves& curves,
                                                   const CutOptions& options);

}  // namespace lastflat
