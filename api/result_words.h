// The words of a result.
#pragma once

#include "api/words.h"
#include "core/measure/report.h"

namespace lastflat::api {

inline constexpr Word<Verdict> verdict_words[]{
    {"pass", Verdict::pass}, {"warn", Verdict::warn}, {"fail", Verdict::fail}};

inline constexpr Word<LastZone> zone_words[]{{"toe", LastZone::toe},
                                             {"joint", LastZone::joint},
                                             {"waist", LastZone::waist},
                                             {"seat", LastZone::seat}};

[[nodiscard]] inline std::string_view verdict_word(const ConstraintReport& report) {
    if (!report.kept && report.relaxed) return "relaxed";
    return word_of(verdict_words, report.kept ? Verdict::pass : Verdict::fail);
}

}  // namespace lastflat::api
