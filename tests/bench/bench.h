// What the benchmark's commands share.
#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "core/constrain/constraint.h"
#include "core/cut/region.h"

namespace lastflat::bench {

/// Milliseconds of one call.
template <class Work>
double milliseconds(const Work& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
        .count();
}

inline double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

/// Times both in turn, so that a drift of the machine meets both; medians in ms.
template <class A, class B>
std::pair<double, double> medians(int runs, const A& a, const B& b) {
    std::vector<double> of_a, of_b;
    for (int i = 0; i < runs; ++i) {
        of_a.push_back(milliseconds(a));
        of_b.push_back(milliseconds(b));
    }
    return {median(of_a), median(of_b)};
}

struct Subject {
    std::string name;
    Region region;
    std::vector<Constraint> constraints;
};

/// Our sample last's halves, the face of our tests, and every model in the folders named by
/// LASTFLAT_LASTS and LASTFLAT_MESHES; what cannot be taken is named on standard error.
[[nodiscard]] std::vector<Subject> subjects(const std::string& only);

/// A table per subject, a row per method, as Markdown.
[[nodiscard]] std::string tables(const std::vector<Subject>& subjects, int runs);

/// The ratios that the project promises, against CGAL in the same run, as Markdown.
[[nodiscard]] std::string speed(int runs);

/// mean_value, one geodesic run and isometric with two sides locked from 1k to `largest` triangles:
/// time, peak memory.
[[nodiscard]] std::string scaling(int largest);

}  // namespace lastflat::bench
