#include "core/export/svg_page.h"

#include <algorithm>

#include "core/text.h"

namespace lastflat {
namespace {

constexpr double smallest_text = 1.6;  // mm; smaller is not legible in print
constexpr double letter_width = 0.56;  // of sans-serif letters, as a share of their size

}  // namespace

Page::Page(const Sheet& sheet)
    : scale_(std::clamp(std::max(sheet.width, sheet.height) / 300.0, 0.5, 2.0)),
      height_(sheet.height) {}

Vec2 Page::operator()(const Vec2& p) const {
    return {p.x() + margin(), height_ - p.y() + margin()};
}

std::string Page::path(const Points2& points, bool closed, int decimals) const {
    std::string d;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec2 p = (*this)(points[i]);
        d += i == 0 ? 'M' : 'L';
        d += svg_number(p.x(), decimals);
        d += ' ';
        d += svg_number(p.y(), decimals);
    }
    return closed ? d + "z" : d;
}

std::string svg_number(double value, int decimals) {
    std::string trimmed = fixed_text(value, decimals);
    while (trimmed.back() == '0') trimmed.pop_back();
    if (trimmed.back() == '.') trimmed.pop_back();
    return trimmed == "-0" ? "0" : trimmed;
}

std::string svg_escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
            case '<': result += "&lt;"; break;
            case '>': result += "&gt;"; break;
            case '&': result += "&amp;"; break;
            case '"': result += "&quot;"; break;
            default: result += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
        }
    }
    return result;
}

double text_width(const std::string& text, double size) {
    const auto letters = std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xC0) != 0x80;  // else it continues a character
    });
    return letter_width * size * static_cast<double>(letters);
}

std::optional<FittedText> fitted(const std::vector<std::string>& texts, double room, double size) {
    for (const std::string& text : texts) {
        const double fits = std::min(size, room / text_width(text, 1.0));
        if (fits >= smallest_text) return FittedText{text, fits};
    }
    return std::nullopt;
}

}  // namespace lastflat
