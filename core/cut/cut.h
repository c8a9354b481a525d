// The surface, opened along curves, falls into regions.
#pragma once

#include "core/cut/insert_curves.h"
#include "core/cut/open_holes.h"
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
    std::vector<std::string> seams{};   ///< curves that are cut, and sewn together (see `seam`)
    HoleRule holes = HoleRule::automatic;
};

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
