#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>

#include "core/border/convex_border.h"
#include "core/constrain/minimise_distortion.h"
#include "core/constrain/scale_to_locks.h"
#include "core/measure/report.h"
#include "core/parameterize/start.h"
#include "tests/bench/bench.h"
#include "tests/bench/peers.h"
#include "tests/helpers/minimum.h"

namespace lastflat::bench {
namespace {

struct Row {
    std::string method;
    std::function<Points2()> map;
    bool own_scale = false;  ///< not to be scaled to the locks or the area afterwards
    bool slow = false;       ///< timed once
};

Row ours(const Subject& subject, const std::string& name, const MethodOptions& method) {
    return {name, [&subject, method] {
                return start_chart(subject.region,
                                   locked_border_edges(subject.region, subject.constraints), method)
                    .chart.uv;
            }};
}

Row energy(const Subject& subject, const std::string& name, const IsotropicEnergy& density,
           const std::vector<Constraint>& locks) {
    return {name,
            [&subject, &density, locks] {
                const Start start = start_chart(
                    subject.region, locked_border_edges(subject.region, locks), MethodOptions{});
                return test::minimised(subject.region, start.chart, locks, density).charts[0].uv;
            },
            !density.scale_free()};
}

std::vector<Row> rows(const Subject& subject, peers::CgalMesh& cgal) {
    using enum MethodName;
    using enum BorderShape;
    static const Mips mips_energy;
    static const GreenLagrange strain_energy;
    static const SymmetricDirichlet dirichlet_energy;
    std::vector<Row> all{
        ours(subject, "tutte, circle", {tutte, circle}),
        ours(subject, "chord_length, circle", {chord_length, circle}),
        ours(subject, "shape_preserving (Floater)", {shape_preserving, square}),
        ours(subject, "shape_preserving, circle", {shape_preserving, circle}),
        ours(subject, "harmonic, circle", {harmonic, circle}),
        ours(subject, "wachspress, circle", {wachspress, circle}),
        ours(subject, "mean_value, square", {mean_value, square}),
        ours(subject, "mean_value, circle", {mean_value, circle}),
        ours(subject, "mean_value, hull", {mean_value, hull}),
        ours(subject, "virtual_border (Lee)", {virtual_border}),
        ours(subject, "geodesic_fan (Kim)", {geodesic_fan, circle, AngleRule::averaged_conformal}),
        ours(subject, "geodesic_fan", {geodesic_fan}),
        energy(subject, "mips", mips_energy, {}),
        energy(subject, "green_lagrange (Maillot)", strain_energy, {}),
        energy(subject, "isometric, no locks", dirichlet_energy, {})};
    if (!subject.constraints.empty())
        all.push_back(energy(subject, "**isometric**", dirichlet_energy, subject.constraints));
    const Points2 border = circle_border(subject.region);
    all.push_back({"CGAL tutte, circle", [&cgal, border] { return cgal.tutte(border); }});
    all.push_back({"CGAL mean value, circle", [&cgal, border] { return cgal.mean_value(border); }});
    all.push_back({"CGAL LSCM", [&cgal] { return cgal.lscm(); }, false, true});
    all.push_back({"CGAL ARAP, lambda 1000", [&cgal] { return cgal.arap(1000); }, false, true});
    return all;
}

std::string number(const char* format, double value) {
    if (!std::isfinite(value)) return "inf";
    char text[48];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

double worst_locked_error(const Subject& subject, const Points2& uv) {
    double worst = 0.0;
    for (const CurveReport& curve : measure_curves(subject.region, uv, subject.constraints)) {
        if (curve.locked) worst = std::max(worst, std::abs(curve.error_mm));
    }
    return worst;
}

std::string line(const Subject& subject, const Row& row, int runs) {
    std::string text = "| " + row.method + " | ";
    Points2 uv;
    std::vector<double> times;
    try {
        for (int i = 0; i < (row.slow ? 1 : runs); ++i) {
            times.push_back(milliseconds([&] { uv = row.map(); }));
        }
    } catch (const std::runtime_error& error) {
        return text + "no map: " + error.what() + " |\n";
    }
    if (!row.own_scale) uv = scaled_to_locks(subject.region, {uv}, subject.constraints).uv;
    const Metrics m = measure_distortion(subject.region, uv);
    for (const double stretch :
         {m.stretch_l2, m.stretch_linf, m.stretch_l2_normalised, m.stretch_linf_normalised,
          m.symmetric_dirichlet, m.angle_distortion}) {
        text += number("%.6g", stretch) + " | ";
    }
    text += number("%.2g", m.area_error) + " | ";
    text += (subject.constraints.empty() ? "" : number("%.2g", worst_locked_error(subject, uv))) +
            " | ";
    return text + std::to_string(m.flipped_triangles) + " | " + number("%.1f", median(times)) +
           " |\n";
}

}  // namespace

std::string tables(const std::vector<Subject>& subjects, int runs) {
    std::string text;
    for (const Subject& subject : subjects) {
        std::cerr << subject.name << std::endl;
        text += "**" + subject.name + "**: " + std::to_string(subject.region.positions.size()) +
                " vertices, " + std::to_string(subject.region.border.size()) + " on the border, " +
                std::to_string(subject.region.triangles.size()) +
                " triangles\n\n"
                "| method | L2 | Linf | L2 norm. | Linf norm. | Dirichlet | "
                "angle | area error | locked, mm | flips | ms |\n"
                "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
        peers::CgalMesh cgal(subject.region);
        for (const Row& row : rows(subject, cgal)) text += line(subject, row, runs);
        text += "\n";
    }
    return text;
}

}  // namespace lastflat::bench
