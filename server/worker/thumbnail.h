// The drawing as a picture.
#pragma once

#include <string>

namespace lastflat::server {

/// A PNG of the drawing, as wide as asked for and at most four times as high, drawn by librsvg's
/// `rsvg-convert`. `svg_file`: path of a result's SVG.
/// Throws: std::runtime_error: the program is missing or has failed.
[[nodiscard]] std::string thumbnail(const std::string& svg_file, int width);

}  // namespace lastflat::server
