#include "server/cli/complaint.h"

#include <iostream>

namespace lastflat::server {

int complain(const api::Problem& problem, Audience audience) {
    if (audience == Audience::programs) {
        std::cerr << api::to_json(problem) << std::endl;
    } else {
        std::cerr << "lastflat: " << problem.detail;
        const std::string pointer = problem.pointer.value_or("");
        if (!pointer.empty() && problem.detail.rfind(pointer, 0) != 0)
            std::cerr << " (" << pointer << " of the request)";
        std::cerr << std::endl;
    }
    return problem.is_bad_input() ? 2 : 1;
}

}  // namespace lastflat::server
