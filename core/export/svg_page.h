// The frame of a drawing, and text that fits into it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/layout/sheet.h"

namespace lastflat {

/// Sheet mm, y up, to drawing mm, y down. Text, lines and marks are in proportion to the sheet,
/// between half and twice of what they are on one of 300 mm.
class Page {
public:
    explicit Page(const Sheet& sheet);

    /// So many mm of a drawing of 300 mm on this one.
    [[nodiscard]] double scaled(double mm) const { return scale_ * mm; }
    [[nodiscard]] double margin() const { return scaled(16.0); }
    [[nodiscard]] double text_size() const { return scaled(4.0); }

    [[nodiscard]] Vec2 operator()(const Vec2& p) const;
    /// The data of a path.
    [[nodiscard]] std::string path(const Points2& points, bool closed, int decimals = 3) const;

private:
    double scale_, height_;
};

/// Without zeros at its end.
[[nodiscard]] std::string svg_number(double value, int decimals = 3);
[[nodiscard]] std::string svg_escaped(const std::string& text);

/// About; mm.
[[nodiscard]] double text_width(const std::string& text, double size);

struct FittedText {
    std::string text;
    double size;  ///< mm
};

/// The first of the texts that fits into `room` at a legible size, at most `size`. Nothing: none
/// does.
[[nodiscard]] std::optional<FittedText> fitted(const std::vector<std::string>& texts, double room,
                                               double size);

}  // namespace lastflat
