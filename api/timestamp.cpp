#include "api/timestamp.h"

#include <cstdio>
#include <ctime>
#include <string_view>

namespace lastflat::api {

std::string rfc3339(std::int64_t milliseconds) {
    const auto seconds = static_cast<std::time_t>(milliseconds / 1000);
    std::tm utc{};
    gmtime_r(&seconds, &utc);
    char text[64];
    std::snprintf(text, sizeof text, "%04d-%02d-%02dT%02d:%02d:%02d.%03dZ", utc.tm_year + 1900,
                  utc.tm_mon + 1, utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec,
                  static_cast<int>(milliseconds % 1000));
    return text;
}

std::optional<std::int64_t> rfc3339_ms(const std::string& text) {
    std::tm utc{};
    const char* rest = strptime(text.c_str(), "%Y-%m-%dT%H:%M:%S", &utc);
    if (rest == nullptr) return std::nullopt;
    std::int64_t milliseconds = 0;
    if (*rest == '.') {
        int digits = 0;
        for (++rest; *rest >= '0' && *rest <= '9'; ++rest, ++digits) {
            if (digits < 3) milliseconds = 10 * milliseconds + (*rest - '0');
        }
        for (; digits > 0 && digits < 3; ++digits) milliseconds *= 10;
    }
    if (std::string_view(rest) != "Z") return std::nullopt;
    return std::int64_t{timegm(&utc)} * 1000 + milliseconds;
}

}  // namespace lastflat::api
