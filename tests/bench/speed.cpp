#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "core/border/convex_border.h"
#include "core/constrain/resolve_conflicts.h"
#include "core/fan/geodesic_centre.h"
#include "core/measure/report.h"
#include "core/parameterize/fixed_border.h"
#include "core/parameterize/start.h"
#include "tests/bench/bench.h"
#include "tests/bench/peers.h"
#include "tests/helpers/face.h"
#include "tests/helpers/sample.h"
#include "tests/helpers/shapes.h"

namespace lastflat::bench {
namespace {

template <class... Arguments>
std::string row(const char* format, Arguments... arguments) {
    char text[256];
    std::snprintf(text, sizeof text, format, arguments...);
    return text;
}

/// A wavy square of about this many vertices.
Region patch(int vertices) {
    return test::saddle(static_cast<int>(std::lround(std::sqrt(vertices))) - 1);
}

Chart fan_of(const Region& region) {
    return start_chart(region, std::vector<bool>(region.border.size(), false),
                       {MethodName::geodesic_fan})
        .chart;
}

std::string maps(const std::string& name, const Region& region, int runs) {
    const Points2 border = circle_border(region);
    peers::CgalMesh cgal(region);
    const auto [own, peer] = medians(
        runs, [&] { (void)flatten_fixed_border(region, mean_value_weights, border); },
        [&] { (void)cgal.mean_value(border); });
    const auto [fan, plain] = medians(
        runs, [&] { (void)fan_of(region); },
        [&] { (void)flatten_fixed_border(region, mean_value_weights, border); });
    return row("| %s | %zu | %.2f | %.1f | %.2f | %.2f | %.2f |\n", name.c_str(),
               region.positions.size(), own, peer, peer / own, fan, fan / plain);
}

/// Start to optimum, as a job does it.
Minimum isometric(const Region& region, const std::vector<Constraint>& constraints,
                  std::size_t threads) {
    const Start start = start_chart(region, locked_border_edges(region, constraints), {});
    const Domain domain({&region});
    const SymmetricDirichlet energy;
    return least_distortion(domain, {start.chart},
                            {constraints, energy, {}, OnConflict::fail, true}, threads, Progress())
        .minimum;
}

std::string optima(const Subject& subject, int runs) {
    const Minimum best = isometric(subject.region, subject.constraints, 1);
    peers::CgalMesh cgal(subject.region);
    Points2 theirs;
    const auto [one, peer] = medians(
        runs, [&] { (void)isometric(subject.region, subject.constraints, 1); },
        [&] { theirs = cgal.arap(1000); });
    const auto [two, free] = medians(
        runs, [&] { (void)isometric(subject.region, subject.constraints, 2); },
        [&] { (void)isometric(subject.region, {}, 1); });
    const double sd = measure_distortion(subject.region, theirs).symmetric_dirichlet;
    return row("| %s | %zu | %.1f | %.1f | %.1f | %d | %.7f | %.1e | %.0f | %.7f | %.1f |\n",
               subject.name.c_str(), subject.region.triangles.size(), one, two, free,
               best.iterations, best.energy, best.worst_error, peer, sd, peer / one);
}

std::string centres(const std::string& name, const Region& region) {
    const ExactGeodesics geodesics(region);
    const GeodesicCentre centre = geodesic_centre(region, geodesics, Progress());
    const double whole =
        milliseconds([&] { (void)geodesic_centre(region, ExactGeodesics(region), Progress()); });
    const double run =
        milliseconds([&] { (void)geodesics.from_vertex(centre.vertex, Progress()); });
    return row("| %s | %zu | %d | %.0f | %.0f |\n", name.c_str(), region.triangles.size(),
               centre.runs, whole, run);
}

/// Runs the work in a child process; its peak memory in MiB, beside what it takes to start.
/// `count`, which the work may set, comes back from the child.
template <class Work>
std::pair<double, double> time_and_memory(const Work& work, int& count) {
    int channel[2];
    if (pipe(channel) != 0) return {NAN, NAN};
    const pid_t child = fork();
    if (child == 0) {
        const double ms = milliseconds(work);
        if (write(channel[1], &ms, sizeof ms) != sizeof ms) _exit(1);
        if (write(channel[1], &count, sizeof count) != sizeof count) _exit(1);
        _exit(0);
    }
    close(channel[1]);
    double ms = NAN;
    const bool answered = read(channel[0], &ms, sizeof ms) == sizeof ms &&
                          read(channel[0], &count, sizeof count) == sizeof count;
    close(channel[0]);
    rusage usage{};
    int status = 0;
    wait4(child, &status, 0, &usage);
    return {answered ? ms : NAN, static_cast<double>(usage.ru_maxrss) / 1024.0};
}

template <class Work>
std::pair<double, double> time_and_memory(const Work& work) {
    int unused = 0;
    return time_and_memory(work, unused);
}

}  // namespace

std::string speed(int runs) {
    std::string text =
        "Medians in ms, both in turn in one run.\n\n"
        "| disk | vertices | mean_value, circle | CGAL's | CGAL's / ours | geodesic_fan | "
        "geodesic_fan / mean_value |\n| --- | --- | --- | --- | --- | --- | --- |\n";
    const SampleLast last = make_sample_last();
    const auto halves = test::flatten_sample(last, test::sample_options(last)).regions;
    text += maps("195 vertices", patch(196), runs);
    text += maps("face", test::face(), runs);
    text += maps("sample last, half", halves[0].region, runs);
    text += maps("wavy square", patch(17000), runs);
    text += maps("wavy square", patch(50000), runs);
    text +=
        "\n| half, locked by edges | triangles | isometric, ms | two threads | free | steps | sd | "
        "worst locked edge, relative | CGAL ARAP, ms | its sd | ARAP / isometric |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
    for (const Subject& subject : subjects(""))
        if (!subject.constraints.empty()) text += optima(subject, runs);
    text +=
        "\n| disk | triangles | runs for the exact centre | centre, ms | one run, ms |\n"
        "| --- | --- | --- | --- | --- |\n";
    text += centres("face", test::face());
    text += centres("sample last, half", halves[0].region);
    text += centres("wavy square", patch(5265));
    text += centres("wavy square", patch(50000));
    return text;
}

std::string scaling(int largest) {
    std::string text =
        "| triangles | map ms | us each | MiB | geodesics ms | us each | MiB | isometric ms | us "
        "each | steps | MiB |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
    const std::vector<Constraint> locks{lock("left"), lock("right")};
    for (const int triangles : {1'000, 3'000, 10'000, 30'000, 100'000, 300'000, 1'000'000}) {
        if (triangles > largest) break;
        const Region region = patch(triangles / 2);
        const auto n = static_cast<double>(region.triangles.size());
        const auto [map, map_peak] = time_and_memory(
            [&] { (void)flatten_fixed_border(region, mean_value_weights, circle_border(region)); });
        const auto [run, run_peak] = time_and_memory([&] {
            (void)ExactGeodesics(region).from_vertex(
                static_cast<Index>(region.positions.size() / 2), Progress());
        });
        int steps = 0;
        const auto [best, best_peak] =
            time_and_memory([&] { steps = isometric(region, locks, 2).iterations; }, steps);
        text += row("| %zu | %.1f | %.2f | %.0f | %.1f | %.2f | %.0f | %.0f | %.1f | %d | %.0f |\n",
                    region.triangles.size(), map, 1000.0 * map / n, map_peak, run, 1000.0 * run / n,
                    run_peak, best, 1000.0 * best / n, steps, best_peak);
    }
    return text;
}

}  // namespace lastflat::bench
