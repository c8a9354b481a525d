#include "core/session/shown_curve.h"

namespace lastflat {
namespace {

template <class Points>
double length_of(const Points& points) {
    double length = 0.0;
    for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
    return length;
}

/// Puts one point after the other on the pattern.
class Drawing {
public:
    explicit Drawing(const PatternMap& map) : map_(map) {}

    void go_to(const Vec3& point) {
        const auto at = map_.to_pattern(point);
        if (!runs_.empty() && runs_.back().region != at.piece) cross_to(point, at.piece);
        if (runs_.empty()) runs_.push_back({at.piece, {}});
        runs_.back().uv.push_back(at.uv);
        last_ = point;
    }
    [[nodiscard]] std::vector<ShownRun> runs() { return std::move(runs_); }

private:
    /// The run ends on the border, and the next begins there.
    void cross_to(const Vec3& point, const std::string& piece) {
        constexpr int halvings = 30;
        Vec3 here = last_, there = point;
        for (int i = 0; i < halvings; ++i) {
            const Vec3 middle = 0.5 * (here + there);
            (map_.to_pattern(middle).piece == runs_.back().region ? here : there) = middle;
        }
        runs_.back().uv.push_back(map_.to_pattern(here, runs_.back().region).uv);
        runs_.push_back({piece, {map_.to_pattern(here, piece).uv}});
    }

    const PatternMap& map_;
    std::vector<ShownRun> runs_;
    Vec3 last_ = Vec3::Zero();
};

}  // namespace

ShownCurve shown_curve(const SurfaceMesh& surface, const SurfaceLine& line, const PatternMap& map) {
    ShownCurve curve{line.name, {}, {}};
    Drawing drawing(map);
    for (const SurfacePoint& point : line.points) {
        curve.on_last.push_back(position_of(surface, point));
        drawing.go_to(curve.on_last.back());
    }
    curve.runs = drawing.runs();
    curve.length_3d = length_of(curve.on_last);
    for (const ShownRun& run : curve.runs) curve.length_2d += length_of(run.uv);
    return curve;
}

}  // namespace lastflat
