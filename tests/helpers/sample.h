// The sample last, as a job would send it.
#pragma once

#include "core/export/write_model.h"
#include "core/flatten.h"
#include "core/sample/sample_last.h"
#include "tests/helpers/constraints.h"

namespace lastflat::test {

inline FlattenOptions sample_options(const SampleLast& last) {
    FlattenOptions options;
    options.request.weld.groups = {"upper"};
    for (const auto& [name, vertices] : last.curves)
        options.request.curves.push_back({name, VertexPath{vertices}});
    options.request.cut = {{"centre_front", "heel"},
                           {{"lateral", last.lateral_vertex}, {"medial", last.medial_vertex}}};
    options.request.constraints = {lock("centre_front"), lock("heel")};
    return options;
}

inline FlattenResult flatten_sample(const SampleLast& last, FlattenOptions options) {
    Progress progress;
    return flatten(write_model_obj(last.mesh), options, progress);
}

}  // namespace lastflat::test
