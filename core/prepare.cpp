#include "core/prepare.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/constrain/check_constraints.h"
#include "core/constrain/constraint_rows.h"
#include "core/landmarks/bare_last.h"
#include "core/numerics/tolerances.h"

namespace lastflat {

std::optional<Landmarks> fill_in_landmarks(const SurfaceMesh& surface, FlattenOptions& options) {
    const bool says_something = !options.cut.cuts.empty() || !options.cut.seams.empty() ||
                                !options.cut.regions.empty() || !options.weld.groups.empty();
    const auto is_open = [&] {
        return std::any_of(surface.mesh.edges_begin(), surface.mesh.edges_end(),
                           [&](auto edge) { return surface.mesh.is_boundary(edge); });
    };
    if (says_something || is_open()) return std::nullopt;
    Landmarks found = find_landmarks(surface);
    const auto is_own = [&](const CurveSource& curve) {
        return std::any_of(options.curves.begin(), options.curves.end(),
                           [&](const CurveSource& own) { return own.name == curve.name; });
    };
    found.curves.erase(std::remove_if(found.curves.begin(), found.curves.end(), is_own),
                       found.curves.end());
    options.curves.insert(options.curves.end(), found.curves.begin(), found.curves.end());
    found.cut.holes = options.cut.holes;
    options.cut = found.cut;
    if (options.constraints.empty()) options.constraints = {lock("centre_front"), lock("heel")};
    return found;
}

namespace {

/// Curves without any edge in a region would be certified by nobody: say so.
void warn_of_absent_curves(const Curves& curves, const std::vector<Region>& regions,
                           std::vector<Warning>& warnings) {
    for (const Curve& curve : curves) {
        const bool present = std::any_of(regions.begin(), regions.end(), [&](const Region& region) {
            return std::any_of(region.runs.begin(), region.runs.end(),
                               [&](const CurveRun& run) { return run.curve == curve.name; });
        });
        if (!present) {
            warnings.push_back({"curve_not_in_regions",
                                "curve '" + curve.name + "' runs through none of the regions",
                                std::nullopt});
        }
    }
}

InsertedCurves put_curves(SurfaceMesh& surface, const FlattenOptions& options, bool found) {
    try {
        return insert_curves(surface, locate_curves(surface, options.curves, options.points));
    } catch (const Error& error) {
        if (found) fail_search(error.what());
        throw;
    }
}

/// The cuts and regions were found; that they do not fit is due to the curves that were not.
[[noreturn]] void fail_beside_own(const Error& error) {
    throw Error(ErrorCode::curve_invalid,
                std::string("the request's curves do not fit those that were found beside them: ") +
                    error.what())
        .at_option({"curves"});
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
                std::to_string(std::lround(seam.length)) + " mm long, by " + place(seam.position) +
                "; cut it where it suits you, or keep it with \"holes\": \"keep\"",
            seam.position};
}

/// Opens holes one after the other: a seam changes the surface on which the next is sought.
class HoleOpening {
public:
    HoleOpening(SurfaceMesh& surface, CutOptions& options, CutSurface& cut)
        : surface_(surface), options_(options), cut_(cut) {}

    void run(const Progress& progress) {
        while (open_one_of_each_region(progress)) {
            if (made_.size() > most_made_seams)
                throw Error(ErrorCode::region_not_disk,
                            "more than " + std::to_string(most_made_seams) +
                                " holes would have to be opened; mend the model, or keep them with "
                                "\"holes\": \"keep\"")
                    .at_option({"holes"});
        }
    }

private:
    /// Whether any had one to open.
    bool open_one_of_each_region(const Progress& progress) {
        std::vector<SurfaceLine> lines;
        const std::size_t before = options_.seams.size();
        for (const Region& region : cut_.regions) {
            const bool is_first =
                std::none_of(region.runs.begin(), region.runs.end(),
                             [&](const CurveRun& run) { return is_in(made_, run.curve); });
            for (HoleSeam& seam : seams_of_next_hole(region, options_.holes, is_first, progress)) {
                const std::string name = seam.curve.empty() ? new_name() : seam.curve;
                cut_.warnings.push_back(seam_warning(region, seam, name));
                made_.push_back(name);
                if (!is_in(options_.seams, name)) options_.seams.push_back(name);
                if (seam.curve.empty())
                    lines.push_back({name, std::move(seam.places), tolerance::geodesic_snap});
            }
        }
        if (options_.seams.size() == before) return false;
        cut_.inserted = insert_more_curves(surface_, std::move(cut_.inserted), lines);
        cut_.regions = cut_into_regions(surface_, cut_.inserted.curves, options_);
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
    CutOptions& options_;
    CutSurface& cut_;
    std::vector<std::string> made_;
    std::size_t number_ = 0;
};

}  // namespace

CutSurface cut_surface(SurfaceMesh& surface, FlattenOptions& options, Found found,
                       const Progress& progress) {
    CutSurface cut;
    cut.inserted = put_curves(surface, options, found == Found::all);
    try {
        cut.regions = cut_into_regions(surface, cut.inserted.curves, options.cut);
    } catch (const Error& error) {
        if (found == Found::some) fail_beside_own(error);
        throw;
    }
    const std::size_t asked = options.cut.seams.size();
    HoleOpening(surface, options.cut, cut).run(progress);
    for (std::size_t s = 0; s < options.cut.seams.size(); ++s) {
        options.constraints.push_back(seam(options.cut.seams[s]));
        if (s < asked) options.constraints.back().option = {"seams", std::to_string(s)};
    }
    check_constraints(options.constraints, cut.inserted.curves, cut.regions);
    (void)coupled_regions(cut.regions, options.constraints);
    check_zones(options.weights.zones, cut.inserted.curves, cut.regions);
    warn_of_absent_curves(cut.inserted.curves, cut.regions, cut.warnings);
    return cut;
}

/// A vertex that was welded to another is named by that one.
void name_welded_vertices(const SurfaceMesh& surface, FlattenOptions& options) {
    const auto rename = [&](Index& vertex) {
        if (surface.is_on_surface(vertex))
            vertex = surface.welded_to[static_cast<std::size_t>(vertex)];
    };
    for (Constraint& constraint : options.constraints) rename(constraint.vertex);
    for (Zone& zone : options.weights.zones) {
        rename(zone.vertex);
        for (Index& vertex : zone.vertices) rename(vertex);
    }
}

}  // namespace lastflat
