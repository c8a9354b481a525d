// The sample last, as a job would send it.
#pragma once

#include "core/export/write_model.h"
#include "core/flatten.h"
#include "core/sample/sample_last.h"

namespace lastflat::test {

inline FlattenOptions sample_options(const SampleLast& last) {
    FlattenOptions options;
    options.weld.groups = {"upper"};
    for (const auto& [name, vertices] : last.curves) options.curves.push_back({name, vertices});
    options.cut = {{"centre_front", "heel"},
                   {{"lateral", last.lateral_vertex, {}}, {"medial", last.medial_vertex, {}}}};
    options.constraints = {lock("centre_front"), lock("heel")};
    return options;
}

inline FlattenResult flatten_sample(const SampleLast& last, FlattenOptions options) {
    Progress progress;
    return flatten(write_model_obj(last.mesh), options, progress);
}

}  // namespace lastflat::test
