#include "core/cut/cut_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/cut/cut.h"
#include "core/cut/open_holes.h"
#include "core/landmarks/bare_last.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

InsertedCurves put_curves(SurfaceMesh& surface, const Plan& plan) {
    try {
        return insert_curves(surface,
                             locate_curves(surface, plan.request.curves, plan.request.points));
    } catch (const Error& error) {
        if (plan.found == Plan::Found::all) fail_search(error.what());
        throw;
    }
}

std::vector<Region> first_regions(const SurfaceMesh& surface, const Curves& curves,
                                  const Plan& plan) {
    try {
        return cut_into_regions(surface, curves, plan.request.cut);
    } catch (const Error& error) {
        if (plan.found != Plan::Found::some) throw;
        throw Error(
            ErrorCode::curve_invalid,
            std::string("the request's curves do not fit those that were found beside them: ") +
                error.what())
            .at_option({"curves"});
    }
}

/// Curves without any edge in a region would be certified by nobody: say so.
void warn_of_absent_curves(CutSurface& cut) {
    for (const Curve& curve : cut.inserted.curves) {
        const bool present =
            std::any_of(cut.regions.begin(), cut.regions.end(), [&](const Region& region) {
                return std::any_of(region.runs.begin(), region.runs.end(),
                                   [&](const CurveRun& run) { return run.curve == curve.name; });
            });
        if (!present) {
            cut.warnings.push_back({"curve_not_in_regions",
                                    "curve '" + curve.name + "' runs through none of the regions",
                                    std::nullopt});
        }
    }
}

/// Holes of broken models are many and small; each seam cuts the whole surface anew.
constexpr std::size_t most_made_seams = 64;

bool is_in(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

Warning seam_warning(const Region& region, const HoleSeam& seam, const std::string& name) {
    const long degrees = std::lround(seam.curvature * 180.0 / std::numbers::pi);
    return {"seam_added",
            "region '" + region.name + "': a hole stands for " + std::to_string(degrees) +
                " degrees of curvature and is opened along " +
                (seam.curve.empty() ? "the new seam '" : "the curve '") + name + "', " +
                std::to_string(std::lround(seam.length)) + " mm long, by " +
                position_text(seam.position) + "; cut it where it suits you",
            seam.position};
}

/// Opens holes one after the other: a seam changes the surface on which the next is sought.
class HoleOpening {
public:
    HoleOpening(SurfaceMesh& surface, const CutOptions& planned, CutSurface& cut)
        : surface_(surface), planned_(planned), cut_(cut) {}

    void run(const Progress& progress) {
        while (open_one_of_each_region(progress)) {
            if (made_.size() > most_made_seams)
                throw Error(ErrorCode::region_not_disk,
                            "more than " + std::to_string(most_made_seams) +
                                " holes would have to be opened; mend the model")
                    .at_option({"holes"});
        }
    }

private:
    /// Whether any had one to open.
    bool open_one_of_each_region(const Progress& progress) {
        std::vector<SurfaceLine> lines;
        const std::size_t before = cut_.seams.size();
        for (const Region& region : cut_.regions) {
            const bool is_first =
                std::none_of(region.runs.begin(), region.runs.end(),
                             [&](const CurveRun& run) { return is_in(made_, run.curve); });
            for (HoleSeam& seam : seams_of_next_hole(region, planned_.holes, is_first, progress)) {
                const std::string name = seam.curve.empty() ? new_name() : seam.curve;
                cut_.warnings.push_back(seam_warning(region, seam, name));
                made_.push_back(name);
                if (!is_in(cut_.seams, name)) cut_.seams.push_back(name);
                if (seam.curve.empty())
                    lines.push_back({name, std::move(seam.points), tolerance::geodesic_snap});
            }
        }
        if (cut_.seams.size() == before) return false;
        cut_.inserted = insert_more_curves(surface_, std::move(cut_.inserted), lines);
        CutOptions with_seams = planned_;
        with_seams.seams = cut_.seams;
        cut_.regions = cut_into_regions(surface_, cut_.inserted.curves, with_seams);
        return true;
    }

    /// A name that no curve has: seam_1, seam_2, ...
    std::string new_name() {
        const Curves& curves = cut_.inserted.curves;
        for (;;) {
            std::string name = "seam_" + std::to_string(++number_);
            if (std::none_of(curves.begin(), curves.end(),
                             [&](const Curve& curve) { return curve.name == name; }))
                return name;
        }
    }

    SurfaceMesh& surface_;
    const CutOptions& planned_;
    CutSurface& cut_;
    std::vector<std::string> made_;
    std::size_t number_ = 0;
};

}  // namespace

CutSurface cut_surface(SurfaceMesh& surface, const Plan& plan, const Progress& progress) {
    CutSurface cut;
    cut.inserted = put_curves(surface, plan);
    cut.regions = first_regions(surface, cut.inserted.curves, plan);
    cut.seams = plan.request.cut.seams;
    HoleOpening(surface, plan.request.cut, cut).run(progress);
    warn_of_absent_curves(cut);
    return cut;
}

}  // namespace lastflat
