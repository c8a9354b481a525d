#include "core/export/write_svg.h"

#include <doctest/doctest.h>

#include <regex>

#include "core/measure/strain_field.h"
#include "core/numerics/geometry.h"
#include "tests/helpers/sample.h"

namespace lastflat {
namespace {

/// The sample last, so many times as large.
FlattenResult sample_of(double times, Shading shading = Shading::area) {
    SampleLast last = make_sample_last();
    for (Vec3& p : last.mesh.positions) p *= times;
    FlattenOptions options = test::sample_options(last);
    options.request.weld.unit_mm = 1.0;
    options.request.shading = shading;
    return test::flatten_sample(last, options);
}

const FlattenResult& sample() {
    static const FlattenResult flat = sample_of(1.0);
    return flat;
}

FlattenResult shaded(Shading shading) {
    FlattenResult flat = sample();
    flat.plan.request.shading = shading;
    return flat;
}

/// A sheet of leather, flat from the start.
FlattenResult sheet_of(double width, double height) {
    const std::string w = std::to_string(width), h = std::to_string(height);
    FlattenOptions options;
    options.request.weld.unit_mm = 1.0;
    options.request.curves = {{"edge", VertexPath{{0, 1, 2, 3, 0}}}};
    Progress progress;
    return flatten(
        "v 0 0 0\nv " + w + " 0 0\nv " + w + " " + h + " 0\nv 0 " + h + " 0\nf 1 2 3 4\n", options,
        progress);
}

std::size_t times_in(const std::string& text, const std::string& part) {
    std::size_t n = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++n;
    return n;
}

std::vector<std::smatch> matches(const std::string& text, const std::string& pattern) {
    const std::regex regex(pattern);
    return {std::sregex_iterator(text.begin(), text.end(), regex), {}};
}

double number_in(const std::string& text, const std::string& pattern) {
    const auto found = matches(text, pattern);
    REQUIRE(!found.empty());
    return std::stod(found.front()[1]);
}

/// The numbers at the end of the key to the colours.
double scale_of(const std::string& svg) {
    return number_in(svg.substr(svg.find("class=\"key\"")), "text-anchor=\"end\">\\+?([0-9.]+)");
}

/// Every text's corners lie on the page, by the width that sans-serif letters have.
void check_texts_fit(const std::string& svg) {
    const double width = number_in(svg, "viewBox=\"0 0 ([0-9.]+)");
    const double height = number_in(svg, "viewBox=\"0 0 [0-9.]+ ([0-9.]+)");
    const double usual = number_in(svg, "text\\{font:([0-9.]+)px");
    const double caption = number_in(svg, "caption\\{font-size:([0-9.]+)px");
    const auto texts =
        matches(svg,
                "<text([^>]*)(?:x=\"([-0-9.]+)\" y=\"([-0-9.]+)\"|"
                "translate\\(([-0-9.]+) ([-0-9.]+)\\) rotate\\(([-0-9.]+)\\))([^>]*)>([^<]*)<");
    REQUIRE(texts.size() >= 4);
    for (const std::smatch& t : texts) {
        const std::string attributes = t[1].str() + t[7].str(), text = t[8];
        CAPTURE(text);
        double size = attributes.find("caption") != std::string::npos ? caption : usual;
        if (attributes.find("font-size:") != std::string::npos)
            size = number_in(attributes, "font-size:([0-9.]+)px");
        CHECK(size >= 1.59);
        const bool is_turned = t[4].matched;
        const Vec2 anchor(std::stod(is_turned ? t[4] : t[2]), std::stod(is_turned ? t[5] : t[3]));
        const double angle = is_turned ? std::stod(t[6]) * M_PI / 180.0 : 0.0;
        const double length = 0.56 * size * static_cast<double>(text.size());
        const double from = attributes.find("middle") != std::string::npos ? -0.5
                            : attributes.find("end") != std::string::npos  ? -1.0
                                                                           : 0.0;
        for (const double along : {from * length, (from + 1.0) * length}) {
            const Vec2 end = anchor + along * Vec2(std::cos(angle), std::sin(angle));
            CHECK(end.x() >= 0.0);
            CHECK(end.x() <= width);
            CHECK(end.y() >= 0.0);
            CHECK(end.y() <= height);
        }
    }
}

}  // namespace

TEST_SUITE("core/export/write_svg") {
    TEST_CASE("the drawing is in millimetres and names every curve with its length") {
        const std::string svg = write_svg(sample());
        CHECK(number_in(svg, "viewBox=\"0 0 ([0-9.]+)") == number_in(svg, " width=\"([0-9.]+)mm"));
        CHECK(times_in(svg, "class=\"cut\"") == 2);
        CHECK(times_in(svg, ">heel 78.71 mm locked<") == 2);
        CHECK(times_in(svg, "data-curve=\"featherline\"") == 2);
        CHECK(times_in(svg, ", ease ") == 4);
        CHECK(svg.find("h100") != std::string::npos);
    }

    TEST_CASE("names from outside cannot break the drawing") {
        FlattenResult hostile = sample();
        hostile.regions[0].region.name = "<script>\"&'";
        const std::string svg = write_svg(hostile);
        CHECK(svg.find("<script>") == std::string::npos);
        CHECK(svg.find("&lt;script&gt;&quot;&amp;") != std::string::npos);
    }

    TEST_CASE("what the leather does has the sign of the report: red stretched, blue gathered") {
        FlattenResult smaller = sheet_of(200, 150), larger = smaller;
        for (Vec2& p : smaller.regions[0].chart.uv) p *= 0.9;
        for (Vec2& p : larger.regions[0].chart.uv) p *= 1.1;
        const std::string stretched = write_svg(smaller), gathered = write_svg(larger);
        CHECK(stretched.find("data-from=\"-") == std::string::npos);
        CHECK(stretched.find("<path fill=\"#be1e2d\"") != std::string::npos);
        for (const auto& m : matches(gathered, "fill=\"#(..)..(..)\" data-from=\"-"))
            CHECK(std::stoi(m[1], nullptr, 16) < std::stoi(m[2], nullptr, 16));
        CHECK(matches(gathered, "data-from=\"[0-9]").empty());
        CHECK(stretched.find(">+23.5 %</text></g>") != std::string::npos);  // 1 / 0.81 - 1
        CHECK(gathered.find(">-17.4 %</text></g>") != std::string::npos);   // 1 / 1.21 - 1
    }

    TEST_CASE("the scale reaches what 99 % of the surface does not exceed, and no further") {
        for (const Shading shading :
             {Shading::area, Shading::stretch, Shading::gather, Shading::shear}) {
            const FlattenResult flat = shaded(shading);
            const double scale = scale_of(write_svg(flat));
            double all = 0.0, beyond = 0.0, far_below = 0.0;
            for (const FlatRegion& r : flat.regions) {
                const auto strains = triangle_strains(r.region, r.chart.uv, shading);
                for (std::size_t t = 0; t < strains.size(); ++t) {
                    const double area = doubled_area_vector(r.region, r.region.triangles[t]).norm();
                    all += area;
                    beyond += std::abs(strains[t]) > scale ? area : 0.0;
                    far_below += std::abs(strains[t]) > 0.9 * scale ? area : 0.0;
                }
            }
            CHECK(beyond <= 0.01 * all);
            CHECK(far_below > 0.01 * all);
        }
    }

    TEST_CASE("the worst place of each piece is marked with the report's number") {
        const auto marked = [](const std::string& svg) {
            std::vector<double> numbers;
            for (const auto& m : matches(svg, "class=\"worst\">.*>([-+][0-9.]+) %</text>"))
                numbers.push_back(std::stod(m[1]));
            return numbers;
        };
        const auto stretched = marked(write_svg(shaded(Shading::stretch)));
        const auto gathered = marked(write_svg(shaded(Shading::gather)));
        REQUIRE(stretched.size() == 2);
        REQUIRE(gathered.size() == 2);
        for (std::size_t r = 0; r < 2; ++r) {
            const StretchReport& report = sample().regions[r].stretch;
            CHECK(std::abs(stretched[r] - report.most_stretched_percent) <= 0.051);
            CHECK(std::abs(gathered[r] - report.most_gathered_percent) <= 0.051);
        }
        CHECK(marked(write_svg(sheet_of(80, 60))).empty());
    }

    TEST_CASE("a drawing without colour has neither scale nor mark") {
        const std::string svg = write_svg(shaded(Shading::plain));
        for (const char* part : {"class=\"strain\"", "class=\"worst\"", "class=\"key\""})
            CHECK(svg.find(part) == std::string::npos);
        CHECK(times_in(svg, "class=\"cut\"") == 2);
    }

    TEST_CASE("colours are areas between levels: a few paths, whatever the number of triangles") {
        const std::string svg = write_svg(sample());
        CHECK(times_in(svg, "data-from=") <= 2 * 2 * 20);
        CHECK(times_in(svg, "data-from=") > 20);
        CHECK(svg.size() < 60 * sample().regions[0].region.triangles.size());
        CHECK(write_svg(sample()) == svg);
    }

    TEST_CASE("text, lines and scale bar fit sheets of any size") {
        const double length = sample().sheet.width;
        const auto line_width = [](const std::string& svg) {
            return number_in(svg, "locked\\{stroke:#c00000;stroke-width:([0-9.]+)");
        };
        const std::string infant = write_svg(sample_of(107.0 / length));
        const std::string usual = write_svg(sample());
        const std::string large = write_svg(sample_of(350.0 / length));
        const std::string sheet = write_svg(sheet_of(80, 60)), tiny = write_svg(sheet_of(9, 9));
        for (const std::string& svg : {infant, usual, large, sheet, tiny}) check_texts_fit(svg);
        CHECK(line_width(infant) < 0.6 * line_width(usual));
        CHECK(line_width(large) > 1.05 * line_width(usual));
        CHECK(infant.find("h100M") != std::string::npos);
        CHECK(sheet.find("h50M") != std::string::npos);
        CHECK(large.find("h100M") != std::string::npos);
        CHECK(number_in(sheet, "viewBox=\"0 0 ([0-9.]+)") < 120.0);
        CHECK(times_in(infant, ">heel ") == 2);
    }

    TEST_CASE("the fan is drawn when asked for, one line for each border vertex") {
        CHECK(times_in(write_svg(sample()), "class=\"fan\"") == 0);
        FlattenResult drawn = sample();
        drawn.plan.request.draw_fan = true;
        const SampleLast last = make_sample_last();
        FlattenOptions options = test::sample_options(last);
        options.request.draw_fan = true;
        const std::string svg = write_svg(test::flatten_sample(last, options));
        CHECK(times_in(svg, "class=\"fan\"") == 2);
        const std::size_t begin = svg.find("class=\"fan\"");
        const std::string lines = svg.substr(begin, svg.find("<circle", begin) - begin);
        CHECK(times_in(lines, "M") == drawn.regions[0].region.border.size());
    }
}

}  // namespace lastflat
