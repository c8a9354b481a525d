#include "api/json.h"
#include "api/problem_of.h"
#include "api/request_json.h"
#include "core/error.h"
#include "core/plan/plan.h"

namespace lastflat::api {

Json json_of(const lastflat::Repair& repair) {
    Json json{{"code", repair.code},
              {"count", repair.count},
              {"detail", repair.detail},
              {"positions", json_of(repair.positions)}};
    if (!repair.lengths_mm.empty()) json["lengths_mm"] = repair.lengths_mm;
    return json;
}

Json json_of(const lastflat::Warning& warning) {
    Json json{{"code", warning.code}, {"detail", detail_of(warning)}};
    if (warning.position) json["position"] = json_of(*warning.position);
    return json;
}

Json json_of(const lastflat::Plan& plan) {
    const Landmarks& found = plan.landmarks.value();
    return {{"foot", found.foot == Foot::left ? "left" : "right"},
            {"up", json_of(found.up)},
            {"forward", json_of(found.forward)},
            {"heel_point", json_of(found.heel_point)},
            {"toe_point", json_of(found.toe_point)},
            {"confidence",
             {{"featherline", found.featherline_confidence},
              {"topline", found.topline_confidence},
              {"sides", found.sides_confidence}}},
            {"request", request_json(plan.request)}};
}

}  // namespace lastflat::api
