#include "api/result_table.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "api/problem_of.h"
#include "api/result_words.h"
#include "core/constrain/constraint.h"
#include "core/result.h"
#include "core/text.h"

namespace lastflat::api {
namespace {

using Row = std::vector<std::string>;

std::size_t letters(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned>(c) & 0xC0U) != 0x80U;
    }));
}

/// Columns under each other: words to the left, which come first and last, numbers to the right.
std::string aligned(const std::vector<Row>& rows, std::size_t words) {
    std::vector<std::size_t> widths(rows.front().size(), 0);
    for (const Row& row : rows) {
        for (std::size_t c = 0; c < row.size(); ++c)
            widths[c] = std::max(widths[c], letters(row[c]));
    }
    std::string text;
    for (const Row& row : rows) {
        for (std::size_t c = 0; c < row.size(); ++c) {
            const std::string room(widths[c] - letters(row[c]), ' ');
            const bool is_last = c + 1 == row.size();
            text += c < words || is_last ? row[c] : room + row[c];
            if (!is_last) text += (c < words ? room : "") + "  ";
        }
        while (text.back() == ' ') text.pop_back();
        text += '\n';
    }
    return text;
}

/// With its sign; what rounds to nothing has none.
std::string signed_text(double value, int decimals) {
    std::string text = fixed_text(std::abs(value), decimals);
    if (text.find_first_not_of("0.") != std::string::npos) text.insert(0, value < 0.0 ? "-" : "+");
    return text;
}

Row length_row(const std::string& region, const std::string& name, double on_last, double in_flat,
               const std::string& verdict) {
    return {region,
            name,
            fixed_text(on_last, 3),
            fixed_text(in_flat, 3),
            signed_text(in_flat - on_last, 6),
            signed_text(ease_percent(on_last, in_flat), 3),
            verdict};
}

std::string curve_table(const FlattenResult& result) {
    std::vector<Row> rows{
        {"region", "curve", "last mm", "flat mm", "flat - last mm", "%", "verdict"}};
    for (const FlatRegion& flat : result.regions) {
        for (const CurveReport& c : flat.curves) {
            rows.push_back(
                length_row(flat.region.name, c.name, c.length_3d_mm, c.length_2d_mm,
                           c.verdict ? std::string(word_of(verdict_words, *c.verdict)) : "-"));
            for (const ZoneReport& zone : c.zones) {
                rows.push_back(length_row(flat.region.name,
                                          "  " + std::string(word_of(zone_words, zone.zone)),
                                          zone.length_3d_mm, zone.length_2d_mm, "-"));
            }
        }
    }
    return "flat - last: above 0 a curve is gathered when it is lasted, below 0 stretched\n" +
           aligned(rows, 2);
}

std::string pair_lines(const FlattenResult& result) {
    std::string text;
    for (const PairReport& p : result.pairs) {
        text += "pair " + p.curve + ": " + p.a + " and " + p.b + " differ by " +
                fixed_text(std::abs(p.difference_mm), 6) + " mm  " +
                std::string(word_of(verdict_words, p.verdict)) + "\n";
    }
    return text;
}

std::string bounds_text(const ConstraintReport& report) {
    if (report.asked_min == report.asked_max) return fixed_text(report.asked_min, 3);
    if (!std::isfinite(report.asked_max)) return "at least " + fixed_text(report.asked_min, 3);
    if (!std::isfinite(report.asked_min)) return "at most " + fixed_text(report.asked_max, 3);
    return fixed_text(report.asked_min, 3) + " to " + fixed_text(report.asked_max, 3);
}

/// What the table of curves does not say.
std::string constraint_lines(const FlattenResult& result) {
    std::string text;
    for (const ConstraintReport& report : result.constraints) {
        const Constraint& asked = result.asked[report.constraint];
        const bool is_area = std::holds_alternative<TotalArea>(asked.demand);
        if (std::holds_alternative<Lock>(asked.demand) && !report.relaxed) continue;
        std::string what = title(asked);
        if (!what.ends_with(report.region)) what += " in " + report.region;
        text += what + ": " + fixed_text(report.reached, 3) + (is_area ? " mm2" : " mm") +
                ", asked " + bounds_text(report) + "  " + std::string(verdict_word(report)) + "\n";
    }
    return text;
}

std::string strain_table(const FlattenResult& result) {
    std::vector<Row> rows{
        {"region", "most gathered %", "most stretched %", "area, median %", "energy", "material"}};
    for (const FlatRegion& flat : result.regions) {
        const StretchReport& s = flat.stretch;
        rows.push_back(
            {flat.region.name, signed_text(s.most_gathered_percent, 2),
             signed_text(s.most_stretched_percent, 2), signed_text(s.area.p50, 2),
             fixed_text(flat.metrics.symmetric_dirichlet, 6),
             s.material_verdict ? std::string(word_of(verdict_words, *s.material_verdict)) : "-"});
    }
    return "strain of the leather when it is lasted: above 0 stretched, below 0 gathered\n" +
           aligned(rows, 1);
}

}  // namespace

std::string to_table(const FlattenResult& result) {
    std::string text =
        curve_table(result) + pair_lines(result) + constraint_lines(result) + strain_table(result);
    for (const Warning& warning : result.warnings) text += "warning: " + detail_of(warning) + "\n";
    return text;
}

}  // namespace lastflat::api
