#include "server/result_format.h"

#include <algorithm>
#include <charconv>

#include "server/submission.h"

namespace lastflat::server {
namespace {

constexpr ResultFormat all_formats[] = {ResultFormat::json, ResultFormat::svg, ResultFormat::glb,
                                        ResultFormat::obj};

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

[[noreturn]] void refuse(int status, const char* code, const std::string& what) {
    throw Refusal({status, code, "",
                   what + "; there are application/json, image/svg+xml, "
                          "model/gltf-binary and model/obj (format=json, svg, glb, obj)",
                   std::nullopt, std::nullopt});
}

}  // namespace

std::string media_type(ResultFormat format) {
    switch (format) {
        case ResultFormat::json: return "application/json";
        case ResultFormat::svg: return "image/svg+xml";
        case ResultFormat::glb: return "model/gltf-binary";
        case ResultFormat::obj: return "model/obj";
    }
    return {};
}

std::string file_ending(ResultFormat format) {
    switch (format) {
        case ResultFormat::json: return ".json";
        case ResultFormat::svg: return ".svg";
        case ResultFormat::glb: return ".glb";
        case ResultFormat::obj: return ".obj";
    }
    return {};
}

Bytes bytes_of(const JobOutput& output, ResultFormat format) {
    switch (format) {
        case ResultFormat::json: return output.json;
        case ResultFormat::svg: return output.svg;
        case ResultFormat::glb: return output.glb;
        case ResultFormat::obj: return output.obj;
    }
    return {};
}

ResultFormat negotiated_format(const http::Request& request) {
    if (const auto wanted = request.query.find("format"); wanted != request.query.end()) {
        for (const ResultFormat format : all_formats) {
            if (file_ending(format) == "." + wanted->second) return format;
        }
        refuse(400, "format_unknown", "there is no format '" + wanted->second.substr(0, 40) + "'");
    }
    const std::string_view accept = request.header("accept");
    if (accept.empty()) return ResultFormat::json;
    ResultFormat best = ResultFormat::json;
    double most = 0.0;
    for (const ResultFormat format : all_formats) {
        const double wanted = acceptance(accept, media_type(format));
        if (wanted > most) {
            most = wanted;
            best = format;
        }
    }
    if (most <= 0.0)
        refuse(406, "not_acceptable", "no format of the result fits the Accept header");
    return best;
}

}  // namespace lastflat::server
