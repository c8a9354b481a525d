#include "server/routes/result_format.h"

#include <algorithm>
#include <charconv>

#include "api/refusal.h"

namespace lastflat::server {
namespace {

std::string trimmed_lower(std::string_view text) {
    const auto begin = text.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return {};
    std::string word(text.substr(begin, text.find_last_not_of(" \t") + 1 - begin));
    std::transform(word.begin(), word.end(), word.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return word;
}

std::string_view next_item(std::string_view& rest, char separator) {
    const auto end = rest.find(separator);
    const std::string_view item = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    return item;
}

/// The weight of one item of Accept (RFC 9110, 12.4.2); 1 unless it says `q=`.
double weight_of(std::string_view parameters) {
    while (!parameters.empty()) {
        const std::string parameter = trimmed_lower(next_item(parameters, ';'));
        if (parameter.rfind("q=", 0) != 0) continue;
        double q = 0.0;
        std::from_chars(parameter.data() + 2, parameter.data() + parameter.size(), q);
        return q;
    }
    return 1.0;
}

/// How much `Accept` wants a type: the weight of its most specific match.
double acceptance(std::string_view accept, const std::string& type) {
    const std::string family = type.substr(0, type.find('/')) + "/*";
    int best = 0;
    double weight = 0.0;
    while (!accept.empty()) {
        std::string_view item = next_item(accept, ',');
        const std::string range = trimmed_lower(next_item(item, ';'));
        const int specific = range == type ? 3 : range == family ? 2 : range == "*/*" ? 1 : 0;
        if (specific <= best) continue;
        best = specific;
        weight = weight_of(item);
    }
    return weight;
}

[[noreturn]] void refuse_format(api::ProblemCode code, const std::string& what) {
    api::refuse(code, what + "; there are " + api::listed(api::result_media_types) +
                          " (format=" + api::listed(api::result_formats) + ")");
}

}  // namespace

ResultFormat negotiated_format(const http::Request& request) {
    if (const auto wanted = request.query.find("format"); wanted != request.query.end()) {
        if (const auto format = api::value_of(api::result_formats, wanted->second)) return *format;
        refuse_format("format_unknown",
                      "there is no format '" + wanted->second.substr(0, 40) + "'");
    }
    const std::string_view accept = request.header("accept");
    if (accept.empty()) return ResultFormat::json;
    ResultFormat best = ResultFormat::json;
    double most = 0.0;
    for (const auto& type : api::result_media_types) {
        const double wanted = acceptance(accept, std::string(type.word));
        if (wanted > most) {
            most = wanted;
            best = type.value;
        }
    }
    if (most <= 0.0)
        refuse_format("not_acceptable", "no format of the result fits the Accept header");
    return best;
}

bool accepts_gzip(const http::Request& request) {
    std::string_view list = request.header("accept-encoding");
    double gzip = 0.0, any = 0.0;
    while (!list.empty()) {
        std::string_view item = next_item(list, ',');
        const std::string coding = trimmed_lower(next_item(item, ';'));
        if (coding == "gzip" || coding == "x-gzip") gzip = weight_of(item) > 0.0 ? 1.0 : -1.0;
        if (coding == "*") any = weight_of(item);
    }
    return gzip > 0.0 || (gzip == 0.0 && any > 0.0);
}

std::optional<ByteRange> wanted_range(const http::Request& request, std::uint64_t size) {
    constexpr std::string_view unit = "bytes=";
    std::string_view text = request.header("range");
    if (text.substr(0, unit.size()) != unit) return std::nullopt;
    text.remove_prefix(unit.size());
    const std::size_t dash = text.find('-');
    if (dash == std::string_view::npos) return std::nullopt;
    const auto number = [](std::string_view digits) -> std::optional<std::uint64_t> {
        std::uint64_t value = 0;
        const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        const bool whole = read.ec == std::errc() && read.ptr == digits.data() + digits.size();
        return whole ? std::optional(value) : std::nullopt;
    };
    const auto first = number(text.substr(0, dash)), last = number(text.substr(dash + 1));
    const bool has_first = dash > 0, has_last = dash + 1 < text.size();
    if ((has_first && !first) || (has_last && !last) || (!has_first && !has_last))
        return std::nullopt;
    if (has_first && has_last && *last < *first) return std::nullopt;
    const bool outside = size == 0 || (has_first ? *first >= size : *last == 0);
    if (outside) {
        api::refuse("range_outside",
                    "the range lies outside of the " + std::to_string(size) + " bytes there are");
    }
    if (!has_first) return ByteRange{size - std::min(size, *last), size - 1};
    return ByteRange{*first, has_last ? std::min(*last, size - 1) : size - 1};
}

}  // namespace lastflat::server
