// Written from coordinates, without the optimiser's rows, so that the one checks the other.
#include <algorithm>
#include <cmath>

#include "core/constrain/pins.h"
#include "core/cut/seam_stretches.h"
#include "core/measure/report.h"
#include "core/numerics/polygon.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

/// What a constraint came to wherever it binds; one overload for each kind.
class ConstraintMeter {
public:
    ConstraintMeter(const std::vector<Region>& regions, const std::vector<Chart>& charts)
        : regions_(regions), charts_(charts) {}

    using Reports = std::vector<ConstraintReport>;

    Reports operator()(const Lock& lock) const {
        return on_runs(lock, [&](std::size_t r, const CurveRun& run) {
            ConstraintReport report = ranged(r, run, 0.0, 0.0);
            if (lock.keep == Keep::edges) worst_edge(r, run, report);
            return report;
        });
    }

    Reports operator()(const Range& range) const {
        return on_runs(range, [&](std::size_t r, const CurveRun& run) {
            return ranged(r, run, range.min_percent, range.max_percent);
        });
    }

    Reports operator()(const Straight& asked) const {
        return on_runs(asked, [&](std::size_t r, const CurveRun& run) { return straight(r, run); });
    }

    Reports operator()(const TotalArea& asked) const {
        Reports reports;
        for (std::size_t r = 0; r < regions_.size(); ++r) {
            if (binds(asked.region, regions_[r])) reports.push_back(area(asked, r));
        }
        return reports;
    }

    Reports operator()(const Pin& asked) const {
        Reports reports;
        for (std::size_t r = 0; r < regions_.size(); ++r) {
            for (const PinnedVertex& p : pinned_vertices(regions_[r], asked))
                reports.push_back(pin(r, p));
        }
        return reports;
    }

    Reports operator()(const Match& asked) const {
        Sides sides = runs_of(asked.curve, asked.region);
        if (sides.size() < 2) {
            for (const auto& side : runs_of(asked.with_curve, asked.with_region))
                sides.push_back(side);
        }
        return {equal({sides[0].first, sides[0].second->vertices},
                      {sides[1].first, sides[1].second->vertices})};
    }

    Reports operator()(const Seam& asked) const {
        std::vector<const Region*> all;
        for (const Region& region : regions_) all.push_back(&region);
        Reports reports;
        for (const SeamStretch& both : seam_stretches(all, asked.curve))
            reports.push_back(equal(both.a, both.b));
        return reports;
    }

private:
    [[nodiscard]] const Vec2& flat(std::size_t r, Index v) const {
        return charts_[r].uv[static_cast<std::size_t>(v)];
    }

    struct Lengths {
        double in_space = 0.0, flat = 0.0;
    };

    [[nodiscard]] Lengths lengths(std::size_t r, const std::vector<Index>& line) const {
        Lengths sum;
        for (std::size_t i = 1; i < line.size(); ++i) {
            sum.in_space += regions_[r].distance(line[i - 1], line[i]);
            sum.flat += (flat(r, line[i]) - flat(r, line[i - 1])).norm();
        }
        return sum;
    }

    static ConstraintReport bounded(double least, double most, double reached, double reference) {
        ConstraintReport report{};
        report.asked_min = least;
        report.asked_max = most;
        report.reached = reached;
        report.residual_mm = reached > most ? reached - most : std::min(reached - least, 0.0);
        report.kept = std::abs(report.residual_mm) <= tolerance::locked_length * reference;
        return report;
    }

    using Sides = std::vector<std::pair<std::size_t, const CurveRun*>>;

    [[nodiscard]] Sides runs_of(const std::string& curve, const std::string& region) const {
        Sides sides;
        for (std::size_t r = 0; r < regions_.size(); ++r) {
            if (!binds(region, regions_[r])) continue;
            for (const CurveRun& run : regions_[r].runs) {
                if (run.curve == curve) sides.emplace_back(r, &run);
            }
        }
        return sides;
    }

    template <class OfCurve, class MeasureRun>
    [[nodiscard]] Reports on_runs(const OfCurve& asked, const MeasureRun& measure_run) const {
        Reports reports;
        for (const auto& [r, run] : runs_of(asked.curve, asked.region)) {
            reports.push_back(measure_run(r, *run));
            reports.back().region = regions_[r].name;
        }
        return reports;
    }

    /// The length of a whole run.
    [[nodiscard]] ConstraintReport ranged(std::size_t r, const CurveRun& run, double min_percent,
                                          double max_percent) const {
        const Lengths sum = lengths(r, run.vertices);
        ConstraintReport report =
            bounded(sum.in_space * (1.0 + min_percent / 100.0),
                    sum.in_space * (1.0 + max_percent / 100.0), sum.flat, sum.in_space);
        report.position = regions_[r].position(run.vertices.front());
        return report;
    }

    void worst_edge(std::size_t r, const CurveRun& run, ConstraintReport& report) const {
        report.residual_mm = 0.0;
        report.kept = true;
        for (std::size_t i = 1; i < run.vertices.size(); ++i) {
            const Index a = run.vertices[i - 1], b = run.vertices[i];
            const double length = regions_[r].distance(a, b);
            const double error = (flat(r, a) - flat(r, b)).norm() - length;
            if (std::abs(error) > tolerance::locked_length * length) report.kept = false;
            if (std::abs(error) <= std::abs(report.residual_mm)) continue;
            report.residual_mm = error;
            report.position = regions_[r].position(a);
        }
    }

    /// The largest distance from the line between the ends.
    [[nodiscard]] ConstraintReport straight(std::size_t r, const CurveRun& run) const {
        const Vec2 from = flat(r, run.vertices.front());
        const Vec2 along = flat(r, run.vertices.back()) - from;
        ConstraintReport report{};
        report.position = regions_[r].position(run.vertices.front());
        for (const Index v : run.vertices) {
            const double offset = std::abs(cross(along, flat(r, v) - from)) / along.norm();
            if (offset <= report.reached) continue;
            report.reached = report.residual_mm = offset;
            report.position = regions_[r].position(v);
        }
        report.kept = report.reached <= tolerance::locked_length * along.norm();
        return report;
    }

    [[nodiscard]] ConstraintReport area(const TotalArea& asked, std::size_t r) const {
        const double on_last = surface_area(regions_[r]);
        const double in_flat = flat_area(regions_[r], charts_[r].uv), size = std::sqrt(on_last);
        ConstraintReport report =
            bounded(on_last * (1.0 + asked.min_percent / 100.0),
                    on_last * (1.0 + asked.max_percent / 100.0), in_flat, on_last);
        report.residual_mm /= size;
        report.region = regions_[r].name;
        report.position = regions_[r].position(regions_[r].border.front());
        return report;
    }

    [[nodiscard]] ConstraintReport pin(std::size_t r, const PinnedVertex& pinned) const {
        const double distance = (flat(r, pinned.vertex) - pinned.at).norm();
        ConstraintReport report = bounded(0.0, 0.0, distance, std::sqrt(surface_area(regions_[r])));
        report.region = regions_[r].name;
        report.position = regions_[r].position(pinned.vertex);
        return report;
    }

    [[nodiscard]] ConstraintReport equal(const SeamStretch::Side& one,
                                         const SeamStretch::Side& other) const {
        const Lengths a = lengths(one.region, one.vertices);
        const Lengths b = lengths(other.region, other.vertices);
        ConstraintReport report = bounded(b.flat, b.flat, a.flat, a.in_space);
        report.region = regions_[one.region].name;
        report.position = regions_[one.region].position(one.vertices.front());
        return report;
    }

    const std::vector<Region>& regions_;
    const std::vector<Chart>& charts_;
};

}  // namespace

std::vector<ConstraintReport> measure_constraints(const std::vector<Region>& regions,
                                                  const std::vector<Chart>& charts,
                                                  const std::vector<Constraint>& constraints) {
    std::vector<ConstraintReport> reports;
    const ConstraintMeter meter(regions, charts);
    for (std::size_t c = 0; c < constraints.size(); ++c) {
        for (ConstraintReport& report : std::visit(meter, constraints[c].demand)) {
            report.constraint = c;
            reports.push_back(std::move(report));
        }
    }
    return reports;
}

}  // namespace lastflat
