#include "core/export/strain_colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/export/super_level.h"
#include "core/measure/strain_field.h"
#include "core/numerics/geometry.h"
#include "core/numerics/tolerances.h"
#include "core/text.h"

namespace lastflat {
namespace {

constexpr int shades = 20;            // to each side of white
constexpr double least_range = 0.1;   // percent or degrees: less is not worth a colour
constexpr double scale_share = 0.99;  // of the surface lies within the scale

/// Rounded up to two digits.
double rounded_up(double value) {
    const double step = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
    return step * std::ceil(value / step - 1e-9);
}

/// White at shade 0, red above, blue below.
std::string colour(int shade) {
    const double t = std::abs(shade) / static_cast<double>(shades);
    const std::array<double, 3> full =
        shade > 0 ? std::array{190.0, 30.0, 45.0} : std::array{25.0, 80.0, 170.0};
    std::array<char, 8> text{};
    const auto mix = [&](double channel) {
        return static_cast<int>(std::lround(255.0 + t * (channel - 255.0)));
    };
    std::snprintf(text.data(), text.size(), "#%02x%02x%02x", mix(full[0]), mix(full[1]),
                  mix(full[2]));
    return text.data();
}

/// The size that `scale_share` of the area does not exceed.
double common_size(const std::vector<FlatRegion>& regions,
                   const std::vector<std::vector<double>>& strains) {
    std::vector<std::pair<double, double>> sizes;
    double total = 0.0, sum = 0.0;
    for (std::size_t r = 0; r < regions.size(); ++r) {
        const Region& region = regions[r].region;
        for (std::size_t t = 0; t < strains[r].size(); ++t) {
            const double area = doubled_area_vector(region, region.triangles[t]).norm();
            sizes.emplace_back(std::abs(strains[r][t]), area);
            total += area;
        }
    }
    std::sort(sizes.begin(), sizes.end());
    for (const auto& [size, area] : sizes) {
        sum += area;
        if (sum >= scale_share * total) return size;
    }
    return 0.0;
}

}  // namespace

StrainColours::StrainColours(const std::vector<FlatRegion>& regions, Shading shading)
    : shading_(shading) {
    for (const FlatRegion& flat : regions)
        strains_.push_back(triangle_strains(flat.region, flat.chart.uv, shading));
    range_ = rounded_up(std::max(least_range, common_size(regions, strains_)));
}

/// Where the colour of a shade, 1 to `shades`, begins.
double StrainColours::level(int shade) const {
    return range_ * (shade - 0.5) / shades;
}

std::string StrainColours::strain_text(double strain) const {
    const std::string size = svg_number(std::abs(strain), range_ < 1.0 ? 2 : 1);
    const std::string sign = size == "0" || shading_ == Shading::shear ? ""
                             : strain < 0                              ? "-"
                                                                       : "+";
    return sign + size + (shading_ == Shading::shear ? "°" : " %");
}

std::string StrainColours::areas(const FlatRegion& flat, std::size_t r, const Points2& positions,
                                 const Page& page) const {
    if (shading_ == Shading::plain) return "";
    std::vector<double> values = vertex_means(flat.region, strains_[r]);
    std::string svg = "<g class=\"strain\">\n";
    for (const int sign : {1, -1}) {
        for (int shade = 1; shade <= shades; ++shade) {
            std::string d;
            for (const Points2& loop :
                 super_level_loops(flat.region, positions, values, level(shade)))
                d += page.path(loop, true, 2);
            if (d.empty()) break;
            svg += "<path fill=\"" + colour(sign * shade) + "\" data-from=\"" +
                   svg_number(sign * level(shade)) + "\" d=\"" + d + "\"/>\n";
        }
        for (double& value : values) value = -value;
    }
    return svg + "</g>\n";
}

std::string StrainColours::worst_mark(const FlatRegion& flat, std::size_t r,
                                      const Points2& positions, const Page& page) const {
    if (shading_ == Shading::plain) return "";
    const std::size_t worst = worst_triangle(strains_[r], shading_);
    if (std::abs(strains_[r][worst]) < least_range) return "";
    Vec2 middle = Vec2::Zero();
    double left = HUGE_VAL, right = -HUGE_VAL;
    for (const Index v : flat.region.triangles[worst]) middle += positions[at(v)] / 3.0;
    for (const Vec2& p : positions) {
        left = std::min(left, p.x());
        right = std::max(right, p.x());
    }
    const Vec2 at = page(middle);
    const std::string text = strain_text(strains_[r][worst]);
    const double width = text_width(text, page.text_size()), gap = page.scaled(2.5);
    const double x = middle.x() > 0.5 * (left + right) ? at.x() - gap - width : at.x() + gap;
    const auto circle = [&](const char* attributes, double radius) {
        return "<circle" + std::string(attributes) + " cx=\"" + svg_number(at.x()) + "\" cy=\"" +
               svg_number(at.y()) + "\" r=\"" + svg_number(page.scaled(radius)) + "\"/>";
    };
    return "<g class=\"worst\">" + circle("", 1.5) + circle(" class=\"dot\"", 0.3) + "<rect x=\"" +
           svg_number(x) + "\" y=\"" + svg_number(at.y() - page.scaled(2.4)) + "\" width=\"" +
           svg_number(width) + "\" height=\"" + svg_number(page.scaled(4.8)) + "\"/><text x=\"" +
           svg_number(x) + "\" y=\"" + svg_number(at.y() + page.scaled(1.4)) + "\">" + text +
           "</text></g>\n";
}

const char* StrainColours::caption() const {
    switch (shading_) {
        case Shading::area:
            return "strain of the leather's area when lasted: below 0 gathered, above 0 stretched";
        case Shading::stretch:
            return "larger strain of the leather when lasted: below 0 gathered, above 0 stretched";
        case Shading::gather:
            return "smaller strain of the leather when lasted: below 0 gathered, above 0 stretched";
        case Shading::shear: return "shear of the leather when lasted";
        case Shading::plain: break;
    }
    return "";
}

std::string StrainColours::key(const Page& page, double top) const {
    if (shading_ == Shading::plain) return "";
    const int first = shading_ == Shading::shear ? 0 : -shades;
    const double cell = page.scaled(2.4), left = page.margin();
    const double end = left + cell * (shades - first + 1);
    const std::string line = svg_number(top + page.scaled(7.5));
    std::string svg = "<g class=\"key\">";
    for (int shade = first; shade <= shades; ++shade) {
        svg += "<rect x=\"" + svg_number(left + cell * (shade - first)) + "\" y=\"" +
               svg_number(top) + "\" width=\"" + svg_number(cell) + "\" height=\"" +
               svg_number(page.scaled(4.0)) + "\" fill=\"" + colour(shade) + "\"/>";
    }
    const auto text = [&](double x, const char* anchor, double strain) {
        return "<text x=\"" + svg_number(x) + "\" y=\"" + line + "\" text-anchor=\"" + anchor +
               "\">" + strain_text(strain) + "</text>";
    };
    if (first < 0) svg += text(left, "start", -range_) + text(0.5 * (left + end), "middle", 0.0);
    if (first == 0) svg += text(left, "start", 0.0);
    svg += text(end, "end", range_);
    return svg + "<text class=\"caption\" x=\"" + svg_number(left) + "\" y=\"" +
           svg_number(top + page.scaled(12.0)) + "\">" + caption() + "</text></g>\n";
}

}  // namespace lastflat
