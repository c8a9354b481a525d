#include "core/export/write_svg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "core/text.h"

namespace lastflat {
namespace {

constexpr double margin = 16.0, footer = 26.0;  // mm; the margin takes the curves' labels
constexpr double colour_range = 0.05;           // stretch at which the colour is full
constexpr int classes = 10;                     // of colour, to each side of "unstretched"

std::string number(double value) {
    std::string trimmed;
    append_fixed(trimmed, value, 3);
    while (trimmed.back() == '0') trimmed.pop_back();
    if (trimmed.back() == '.') trimmed.pop_back();
    return trimmed == "-0" ? "0" : trimmed;
}

std::string fixed(double value, int decimals) {
    std::string text;
    append_fixed(text, value, decimals);
    return text;
}

std::string escaped(const std::string& text) {
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

/// White where the flat piece is as large as the last, red where larger, blue where smaller.
std::string colour(int level) {
    const double t = std::abs(level) / static_cast<double>(classes);
    const std::array<double, 3> full =
        level > 0 ? std::array{190.0, 30.0, 45.0} : std::array{25.0, 80.0, 170.0};
    char text[8];
    const auto mix = [&](double channel) {
        return static_cast<int>(std::lround(255.0 + t * (channel - 255.0)));
    };
    std::snprintf(text, sizeof text, "#%02x%02x%02x", mix(full[0]), mix(full[1]), mix(full[2]));
    return text;
}

/// Sheet millimetres, y up, to drawing millimetres, y down.
class Page {
public:
    explicit Page(const Sheet& sheet) : height_(sheet.height) {}
    [[nodiscard]] Vec2 operator()(const Vec2& p) const {
        return {p.x() + margin, height_ - p.y() + margin};
    }
    [[nodiscard]] std::string point(const Vec2& p) const {
        const Vec2 q = (*this)(p);
        return number(q.x()) + " " + number(q.y());
    }

private:
    double height_;
};

/// The triangles, one path for each class of colour; strokes of the same colour close the seams
/// between them.
std::string stretch_paths(const FlatRegion& flat, const Points2& positions, const Page& page) {
    std::array<std::string, 2 * classes + 1> paths;
    std::vector<std::string> corners;  // each is a corner of about six triangles
    corners.reserve(positions.size());
    for (const Vec2& p : positions) corners.push_back(page.point(p));
    const auto stretches = signed_stretches(flat.region, flat.chart.uv);
    for (std::size_t t = 0; t < stretches.size(); ++t) {
        const double share = std::clamp((stretches[t] - 1.0) / colour_range, -1.0, 1.0);
        auto& path = paths[static_cast<std::size_t>(std::lround(share * classes) + classes)];
        const Triangle& triangle = flat.region.triangles[t];
        for (std::size_t i = 0; i < 3; ++i) {
            path += i == 0 ? 'M' : 'L';
            path += corners[at(triangle[i])];
        }
        path += "z";
    }
    std::string svg;
    int level = -classes;
    for (const std::string& path : paths) {
        const std::string fill = colour(level++);
        if (path.empty()) continue;
        svg.append("<path fill=\"").append(fill).append("\" stroke=\"").append(fill);
        svg.append("\" d=\"").append(path).append("\"/>\n");
    }
    return svg;
}

std::string polyline(const Points2& points, const Page& page, bool closed) {
    std::string d;
    for (std::size_t i = 0; i < points.size(); ++i) {
        d += i == 0 ? 'M' : 'L';
        d += page.point(points[i]);
    }
    return closed ? d + "z" : d;
}

/// Around the piece, and around every hole.
std::string cut_line(const Outline& outline, const Placement& placement, const Page& page) {
    const auto closed = [&](const OutlineLoop& loop) {
        Points2 points;
        for (const Vec2& p : loop.points) points.push_back(placement.apply(p));
        return polyline(points, page, true);
    };
    std::string d = closed(outline);
    for (const OutlineLoop& hole : outline.holes) d += closed(hole);
    return d;
}

std::string label_text(const CurveReport& report) {
    const std::string text = escaped(report.name) + " " + fixed(report.length_2d_mm, 2) + " mm";
    if (report.locked) return text + " locked";
    return text + " (last " + fixed(report.length_3d_mm, 2) + ", " +
           (report.error_mm < 0 ? "" : "+") + fixed(report.error_mm, 2) + ")";
}

/// The curve's name and lengths along it, inside the piece, where no other piece can lie.
std::string label(const FlatRegion& flat, std::size_t run_index, const Points2& positions,
                  const Page& page) {
    const CurveRun& run = flat.region.runs[run_index];
    const std::size_t last = run.vertices.size() - 1, middle = run.vertices.size() / 2;
    const std::size_t reach = std::max<std::size_t>(1, last / 6);
    const auto at = [&](std::size_t i) {
        return page(positions[static_cast<std::size_t>(run.vertices[i])]);
    };
    Vec2 along = at(std::min(last, middle + reach)) - at(middle - std::min(middle, reach));
    if (along.x() < 0.0) along = -along;  // so that no text stands on its head
    along = along.norm() > 0.0 ? Vec2(along.normalized()) : Vec2::UnitX();
    Vec2 centre = Vec2::Zero();
    for (const Index v : flat.region.border) centre += page(positions[static_cast<std::size_t>(v)]);
    centre /= static_cast<double>(flat.region.border.size());
    const Vec2 down(-along.y(), along.x());
    // Below the curve, the text's own height comes on top of the distance.
    const double offset = down.dot(centre - at(middle)) > 0.0 ? 5.0 : -2.0;
    const Vec2 anchor = at(middle) + offset * down;
    const double degrees = std::atan2(along.y(), along.x()) * 180.0 / std::numbers::pi;
    return "<text transform=\"translate(" + number(anchor.x()) + " " + number(anchor.y()) +
           ") rotate(" + number(degrees) + ")\" text-anchor=\"middle\">" +
           label_text(flat.curves[run_index]) + "</text>\n";
}

/// The shortest paths on the last from the fan's centre to the border, as they lie in the flat.
std::string fan_lines(const GeodesicFan& fan, const Points2& positions, const Page& page) {
    std::string d;
    for (const FanSpoke& spoke : fan.spokes) {
        Points2 line;
        for (const PathPoint& point : spoke.path.points)
            line.push_back(position_of(point, positions));
        d += polyline(line, page, false);
    }
    const Vec2 centre = page(positions[static_cast<std::size_t>(fan.centre)]);
    return "<g class=\"fan\"><path d=\"" + d + "\"/><circle cx=\"" + number(centre.x()) +
           "\" cy=\"" + number(centre.y()) + "\" r=\"1\"/></g>\n";
}

std::string piece(const FlatRegion& flat, const Placement& placement, const Page& page,
                  bool draw_fan) {
    Points2 positions;
    for (const Vec2& p : flat.chart.uv) positions.push_back(placement.apply(p));
    Vec2 centre = Vec2::Zero();
    for (const Vec2& p : flat.outline.points)
        centre += page(placement.apply(p)) / static_cast<double>(flat.outline.points.size());
    const std::string name = escaped(flat.region.name);
    std::string svg = "<g id=\"" + name + "\" class=\"piece\">\n<g class=\"stretch\">\n" +
                      stretch_paths(flat, positions, page) + "</g>\n" +
                      (draw_fan && flat.fan ? fan_lines(*flat.fan, positions, page) : "") +
                      "<path class=\"cut\" d=\"" + cut_line(flat.outline, placement, page) +
                      "\"/>\n";
    for (std::size_t i = 0; i < flat.region.runs.size(); ++i) {
        Points2 points;
        for (const Index v : flat.region.runs[i].vertices)
            points.push_back(positions[static_cast<std::size_t>(v)]);
        svg += "<path class=\"curve" + std::string(flat.curves[i].locked ? " locked" : "") +
               "\" data-curve=\"" + escaped(flat.region.runs[i].curve) + "\" d=\"" +
               polyline(points, page, false) + "\"/>\n" + label(flat, i, positions, page);
    }
    svg += "<text class=\"name\" x=\"" + number(centre.x()) + "\" y=\"" + number(centre.y()) +
           "\" text-anchor=\"middle\">" + name + (placement.mirrored ? " (mirrored)" : "") +
           "</text>\n";
    return svg + "</g>\n";
}

std::string scale_bar(double y) {
    std::string svg = "<g class=\"mark\"><path d=\"M" + number(margin) + " " + number(y) + "h100M" +
                      number(margin) + " " + number(y - 2) + "v4M" + number(margin + 50) + " " +
                      number(y - 1.5) + "v3M" + number(margin + 100) + " " + number(y - 2) +
                      "v4\"/>";
    return svg + "<text x=\"" + number(margin) + "\" y=\"" + number(y + 6) +
           "\">100 mm; print at 100 %</text></g>\n";
}

std::string colour_key(double y, double right) {
    const double cell = 3.0, left = std::max(margin + 110.0, right - cell * (2 * classes + 1));
    std::string svg = "<g class=\"key\">";
    for (int level = -classes; level <= classes; ++level) {
        svg += "<rect x=\"" + number(left + cell * (level + classes)) + "\" y=\"" + number(y - 2) +
               "\" width=\"3\" height=\"4\" fill=\"" + colour(level) + "\"/>";
    }
    const double end = left + cell * (2 * classes + 1);
    return svg + "<text x=\"" + number(left) + "\" y=\"" + number(y + 6) +
           "\">-5 %</text><text x=\"" + number(0.5 * (left + end)) + "\" y=\"" + number(y + 6) +
           "\" text-anchor=\"middle\">flat against last</text><text x=\"" + number(end) +
           "\" y=\"" + number(y + 6) + "\" text-anchor=\"end\">+5 %</text></g>\n";
}

}  // namespace

std::string write_svg(const FlattenResult& result) {
    const Page page(result.sheet);
    const double width = std::max(result.sheet.width, 180.0) + 2.0 * margin;
    const double height = result.sheet.height + 2.0 * margin + footer;
    std::string svg =
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + number(width) + "mm\" height=\"" +
        number(height) + "mm\" viewBox=\"0 0 " + number(width) + " " + number(height) +
        "\">\n<style>.stretch path{stroke-width:.08}.cut{fill:none;stroke:#000;stroke-width:.25}"
        ".curve{fill:none;stroke:#0a7d38;stroke-width:.5}.locked{stroke:#c00000;stroke-width:.6}"
        "text{font:4px sans-serif;fill:#111}.name{font-size:7px}"
        ".fan path{fill:none;stroke:#35618f;stroke-width:.12}.fan circle{fill:#35618f}"
        ".mark path{fill:none;stroke:#000;stroke-width:.3}</style>\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
    for (std::size_t r = 0; r < result.regions.size(); ++r) {
        svg += piece(result.regions[r], result.sheet.placements[r], page,
                     result.plan.request.draw_fan);
    }
    const double y = result.sheet.height + 2.0 * margin + 8.0;
    return svg + scale_bar(y) + colour_key(y, width - margin) + "</svg>\n";
}

}  // namespace lastflat
