#include "core/cut/find_border.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "core/error.h"
#include "core/numerics/tolerances.h"

namespace lastflat {
namespace {

std::string loop_places(const Region& region, const std::vector<std::vector<Index>>& loops) {
    std::string text;
    for (std::size_t i = 0; i < loops.size() && i < 6; ++i) {
        text += (i == 0 ? " at " : ", ") + position_text(region.position(loops[i].front()));
    }
    return loops.size() > 6 ? text + " ..." : text;
}

/// The largest shadow of the loop on a plane, doubled: that of a slit is nothing.
double spanned_area(const Region& region, const std::vector<Index>& loop) {
    const Vec3& origin = region.position(loop.front());
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 1; i < loop.size(); ++i)
        sum += (region.position(loop[i - 1]) - origin).cross(region.position(loop[i]) - origin);
    return sum.norm();
}

std::size_t outer_loop(const Region& region, const std::vector<std::vector<Index>>& loops) {
    const auto turnings = loop_turnings(region, loops);
    const double most = *std::max_element(turnings.begin(), turnings.end());
    std::size_t best = 0;
    double largest = -1.0;
    for (std::size_t k = 0; k < loops.size(); ++k) {
        const double area =
            turnings[k] < most - tolerance::alike_turning ? -1.0 : spanned_area(region, loops[k]);
        if (area <= largest) continue;
        largest = area;
        best = k;
    }
    return best;
}

[[noreturn]] void fail(const Region& region, const std::string& what) {
    throw Error(ErrorCode::region_not_disk, "region '" + region.name + "' is not a disk: " + what)
        .at_option({"regions", region.name})
        .at_position(region.position(0));
}

}  // namespace

void find_border(Region& region) {
    region.half_edges = HalfEdges(region);
    auto loops = region.half_edges.border_loops();
    std::size_t border_edges = 0;
    for (const auto& loop : loops) border_edges += loop.size();
    const auto vertices = static_cast<std::int64_t>(region.positions.size());
    const auto faces = static_cast<std::int64_t>(region.triangles.size());
    const auto sides = (3 * faces + static_cast<std::int64_t>(border_edges)) / 2;
    const std::int64_t euler = vertices - sides + faces;  // 2 - 2 genus - loops
    const std::int64_t genus = (2 - euler - static_cast<std::int64_t>(loops.size())) / 2;
    if (loops.empty()) {
        fail(region, "it is closed (no border" +
                         (genus > 0 ? ", genus " + std::to_string(genus) : std::string()) +
                         "); cut it open along curves");
    }
    if (genus > 0) {
        fail(region, "genus " + std::to_string(genus) + ", " + std::to_string(loops.size()) +
                         " border loop(s)" + loop_places(region, loops) + "; cut its handles open");
    }
    const auto outer = loops.begin() + static_cast<std::ptrdiff_t>(outer_loop(region, loops));
    region.border = std::move(*outer);
    loops.erase(outer);
    region.holes = std::move(loops);
}

}  // namespace lastflat
