// Based on: Damerau, "A technique for computer detection and correction of spelling errors",
// CACM 1964; the distance of optimal string alignment.
#include "api/nearest_name.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace lastflat::api {
namespace {

/// Longer words are not compared: the time grows with the square of their length.
constexpr std::size_t longest_word = 64;

std::size_t spelling_distance(std::string_view a, std::string_view b) {
    std::array<std::vector<std::size_t>, 3> rows;  // of the letters before last, the last, this one
    for (auto& row : rows) row.resize(b.size() + 1);
    std::iota(rows[1].begin(), rows[1].end(), 0);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        rows[2][0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            rows[2][j] = std::min({rows[1][j] + 1, rows[2][j - 1] + 1,
                                   rows[1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                rows[2][j] = std::min(rows[2][j], rows[0][j - 2] + 1);
        }
        std::rotate(rows.begin(), rows.begin() + 1, rows.end());
    }
    return rows[1][b.size()];
}

}  // namespace

std::optional<std::string> nearest_name(std::string_view word,
                                        const std::vector<std::string>& names) {
    if (word.size() > longest_word) return std::nullopt;
    std::size_t most = std::max<std::size_t>(1, word.size() / 3);
    std::optional<std::string> nearest;
    for (const std::string& name : names) {
        if (name.size() > longest_word) continue;
        const std::size_t distance = spelling_distance(word, name);
        if (distance > most || (nearest && distance == most)) continue;
        most = distance;
        nearest = name;
    }
    return nearest;
}

std::string suggestion(std::string_view word, const std::vector<std::string>& names) {
    const auto nearest = nearest_name(word, names);
    return nearest ? "; did you mean '" + *nearest + "'?" : "";
}

}  // namespace lastflat::api
