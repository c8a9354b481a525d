#include "core/export/write_svg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/export/strain_colours.h"
#include "core/text.h"

namespace lastflat {
namespace {

/// Around the piece, and around every hole.
std::string cut_line(const Outline& outline, const Placement& placement, const Page& page) {
    const auto closed = [&](const OutlineLoop& loop) {
        Points2 points;
        for (const Vec2& p : loop.points) points.push_back(placement.apply(p));
        return page.path(points, true);
    };
    std::string d = closed(outline);
    for (const OutlineLoop& hole : outline.holes) d += closed(hole);
    return d;
}

/// From the longest to the shortest.
std::vector<std::string> label_texts(const CurveReport& report) {
    const std::string flat = report.name + " " + fixed_text(report.length_2d_mm, 2) + " mm";
    if (report.locked) return {flat + " locked", flat, report.name};
    const std::string ease =
        (report.error_mm < 0 ? "" : "+") + fixed_text(report.error_mm, 2) + " mm";
    return {flat + " (last " + fixed_text(report.length_3d_mm, 2) + ", ease " + ease + ")",
            report.name + ", ease " + ease, report.name};
}

std::string size_attribute(double size) {
    return " style=\"font-size:" + svg_number(size) + "px\"";
}

/// A line by the way along it.
class Way {
public:
    explicit Way(Points2 points) : points_(std::move(points)), lengths_{0.0} {
        for (std::size_t i = 1; i < points_.size(); ++i)
            lengths_.push_back(lengths_.back() + (points_[i] - points_[i - 1]).norm());
    }
    [[nodiscard]] double length() const { return lengths_.back(); }
    [[nodiscard]] Vec2 at(double way) const {
        const auto next = std::upper_bound(lengths_.begin() + 1, lengths_.end() - 1, way);
        const auto i = static_cast<std::size_t>(next - lengths_.begin());
        const double step = lengths_[i] - lengths_[i - 1];
        const double share =
            step > 0.0 ? std::clamp((way - lengths_[i - 1]) / step, 0.0, 1.0) : 0.0;
        return points_[i - 1] + share * (points_[i] - points_[i - 1]);
    }

private:
    Points2 points_;
    std::vector<double> lengths_;
};

/// Where on its way a line is straight for about `width`, as near to its middle as may be.
double straight_place(const Way& line, double width) {
    constexpr std::array shares{0.5, 0.375, 0.625, 0.25, 0.75, 0.125, 0.875};
    constexpr double straight = 0.98;  // as the share of the way that its ends are apart
    double best = 0.0, place = 0.0;
    for (const double share : shares) {
        const double way = share * line.length();
        const double half = std::min({0.5 * width, way, line.length() - way});
        const double apart = (line.at(way + half) - line.at(way - half)).norm() / (2.0 * half);
        if (apart <= best) continue;
        best = apart;
        place = way;
        if (apart >= straight) break;
    }
    return place;
}

/// The curve's name and lengths along it, inside the piece, where no other piece can lie; as much
/// of it as fits.
std::string label(const FlatRegion& flat, std::size_t run_index, const Points2& positions,
                  const Page& page) {
    Points2 points;
    Eigen::AlignedBox2d box;
    for (const Index v : flat.region.runs[run_index].vertices) {
        points.push_back(page(positions[at(v)]));
        box.extend(points.back());
    }
    const auto text =
        fitted(label_texts(flat.curves[run_index]), 0.8 * box.diagonal().norm(), page.text_size());
    if (!text) return "";
    const Way line(std::move(points));
    const double width = std::min(text_width(text->text, text->size), 0.5 * line.length());
    const double place = straight_place(line, width);
    const Vec2 middle = line.at(place);
    Vec2 along = line.at(place + 0.5 * width) - line.at(place - 0.5 * width);
    if (along.x() < 0.0) along = -along;  // so that no text stands on its head
    along = along.norm() > 0.0 ? Vec2(along.normalized()) : Vec2::UnitX();
    Vec2 centre = Vec2::Zero();
    for (const Index v : flat.region.border) centre += page(positions[at(v)]);
    centre /= static_cast<double>(flat.region.border.size());
    const Vec2 down(-along.y(), along.x());
    const bool is_below = down.dot(centre - middle) > 0.0;
    constexpr int samples = 16;
    double offset = 0.0;  // as far as the curve bends towards the text
    for (int i = 0; i <= samples; ++i) {
        const double bend =
            down.dot(line.at(place + (static_cast<double>(i) / samples - 0.5) * width) - middle);
        offset = is_below ? std::max(offset, bend) : std::min(offset, bend);
    }
    // Below the curve, the text's own height comes on top of the distance.
    const Vec2 anchor = middle + (offset + (is_below ? 1.25 : -0.5) * text->size) * down;
    const double degrees = std::atan2(along.y(), along.x()) * 180.0 / std::numbers::pi;
    return "<text transform=\"translate(" + svg_number(anchor.x()) + " " + svg_number(anchor.y()) +
           ") rotate(" + svg_number(degrees) + ")\" text-anchor=\"middle\"" +
           size_attribute(text->size) + ">" + svg_escaped(text->text) + "</text>\n";
}

std::string curve_lines(const FlatRegion& flat, const Points2& positions, const Page& page) {
    std::string svg;
    for (std::size_t i = 0; i < flat.region.runs.size(); ++i) {
        Points2 points;
        for (const Index v : flat.region.runs[i].vertices) points.push_back(positions[at(v)]);
        svg += "<path class=\"curve" + std::string(flat.curves[i].locked ? " locked" : "") +
               "\" data-curve=\"" + svg_escaped(flat.region.runs[i].curve) + "\" d=\"" +
               page.path(points, false) + "\"/>\n" + label(flat, i, positions, page);
    }
    return svg;
}

/// In the middle of the outline.
std::string name_text(const FlatRegion& flat, const Placement& placement, const Page& page) {
    Eigen::AlignedBox2d box;
    Vec2 centre = Vec2::Zero();
    for (const Vec2& p : flat.outline.points) {
        const Vec2 q = page(placement.apply(p));
        box.extend(q);
        centre += q / static_cast<double>(flat.outline.points.size());
    }
    const std::string& name = flat.region.name;
    const auto text = fitted({name + (placement.mirrored ? " (mirrored)" : ""), name},
                             0.8 * box.sizes().x(), page.scaled(7.0));
    if (!text) return "";
    return "<text class=\"name\" x=\"" + svg_number(centre.x()) + "\" y=\"" +
           svg_number(centre.y()) + "\" text-anchor=\"middle\"" + size_attribute(text->size) + ">" +
           svg_escaped(text->text) + "</text>\n";
}

/// The shortest paths on the last from the fan's centre to the border, as they lie in the flat.
std::string fan_lines(const GeodesicFan& fan, const Points2& positions, const Page& page) {
    std::string d;
    for (const FanSpoke& spoke : fan.spokes) {
        Points2 line;
        for (const PathPoint& point : spoke.path.points)
            line.push_back(position_of(point, positions));
        d += page.path(line, false);
    }
    const Vec2 centre = page(positions[at(fan.centre)]);
    return "<g class=\"fan\"><path d=\"" + d + "\"/><circle cx=\"" + svg_number(centre.x()) +
           "\" cy=\"" + svg_number(centre.y()) + "\" r=\"" + svg_number(page.scaled(1.0)) +
           "\"/></g>\n";
}

std::string piece(const FlattenResult& result, std::size_t r, const StrainColours& colours,
                  const Page& page) {
    const FlatRegion& flat = result.regions[r];
    const Placement& placement = result.sheet.placements[r];
    Points2 positions;
    for (const Vec2& p : flat.chart.uv) positions.push_back(placement.apply(p));
    const bool with_fan = result.plan.request.draw_fan && flat.fan.has_value();
    return "<g id=\"" + svg_escaped(flat.region.name) + "\" class=\"piece\">\n" +
           colours.areas(flat, r, positions, page) +
           (with_fan ? fan_lines(*flat.fan, positions, page) : "") + "<path class=\"cut\" d=\"" +
           cut_line(flat.outline, placement, page) + "\"/>\n" + curve_lines(flat, positions, page) +
           colours.worst_mark(flat, r, positions, page) + name_text(flat, placement, page) +
           "</g>\n";
}

/// The longest that fits into so many mm.
std::string scale_bar(const Page& page, double top, double room) {
    constexpr std::array lengths{100, 50, 20, 10, 5};
    int length = lengths.back();
    for (const int longer : lengths) {
        if (length < longer && longer <= room) length = longer;
    }
    const double left = page.margin(), tick = page.scaled(2.0), y = top + tick;
    const auto at = [&](double x) { return svg_number(left + x) + " "; };
    const auto upright = [&](double x, double half) {
        return "M" + at(x) + svg_number(y - half) + "v" + svg_number(2.0 * half);
    };
    return "<g class=\"mark\"><path d=\"M" + at(0.0) + svg_number(y) + "h" +
           std::to_string(length) + upright(0.0, tick) + upright(0.5 * length, 0.75 * tick) +
           upright(length, tick) + "\"/><text x=\"" + svg_number(left) + "\" y=\"" +
           svg_number(y + page.scaled(6.0)) + "\">" + std::to_string(length) +
           " mm; print at 100 %</text></g>\n";
}

std::string style(const Page& page) {
    const auto mm = [&](double width) { return svg_number(page.scaled(width)); };
    return "<style>.strain path{fill-rule:evenodd}.cut{fill:none;stroke:#000;stroke-width:" +
           mm(0.25) + "}.curve{fill:none;stroke:#0a7d38;stroke-width:" + mm(0.5) +
           "}.locked{stroke:#c00000;stroke-width:" + mm(0.6) +
           "}text{font:" + svg_number(page.text_size()) +
           "px sans-serif;fill:#111}.caption{font-size:" + mm(3.2) +
           "px}.fan path{fill:none;stroke:#35618f;stroke-width:" + mm(0.12) +
           "}.fan circle{fill:#35618f}.worst circle{fill:none;stroke:#000;stroke-width:" + mm(0.3) +
           "}.worst .dot{fill:#000}.worst rect{fill:#fff;fill-opacity:.7}.mark "
           "path{fill:none;stroke:#000;stroke-width:" +
           mm(0.3) + "}.key rect{shape-rendering:crispEdges}</style>\n";
}

}  // namespace

std::string write_svg(const FlattenResult& result) {
    const Page page(result.sheet);
    const StrainColours colours(result.regions, result.plan.request.shading);
    const double content =
        std::max({result.sheet.width, text_width("100 mm; print at 100 %", page.text_size()),
                  text_width(colours.caption(), page.scaled(3.2))});
    const double width = content + 2.0 * page.margin();
    const double footer = result.sheet.height + 2.0 * page.margin();
    const double height = footer + page.scaled(32.0);
    std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + svg_number(width) +
                      "mm\" height=\"" + svg_number(height) + "mm\" viewBox=\"0 0 " +
                      svg_number(width) + " " + svg_number(height) + "\">\n" + style(page) +
                      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
    for (std::size_t r = 0; r < result.regions.size(); ++r) svg += piece(result, r, colours, page);
    return svg + scale_bar(page, footer, content) + colours.key(page, footer + page.scaled(14.0)) +
           "</svg>\n";
}

}  // namespace lastflat
