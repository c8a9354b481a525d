#include "core/export/write_flat_glb.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/export/glb_container.h"

namespace lastflat {
namespace {

using Json = nlohmann::ordered_json;

constexpr double metre = 1000.0;  // mm

/// The middle of a curve's vertices in all regions.
std::optional<Vec3> middle_of(const FlattenResult& result, const char* curve) {
    Vec3 sum = Vec3::Zero();
    double count = 0.0;
    for (const FlatRegion& flat : result.regions) {
        for (const CurveRun& run : flat.region.runs) {
            if (run.curve != curve) continue;
            for (const Index v : run.vertices) sum += flat.region.position(v);
            count += static_cast<double>(run.vertices.size());
        }
    }
    if (count == 0.0) return std::nullopt;
    return Vec3(sum / count);
}

/// The axis of the model that is nearest to up; Y if nothing tells.
Vec3 up_of(const FlattenResult& result) {
    Vec3 way = Vec3::UnitY();
    if (result.plan.landmarks) {
        way = result.plan.landmarks->up;
    } else {
        const auto low = middle_of(result, curve_name::featherline),
                   high = middle_of(result, curve_name::topline);
        if (low && high) way = *high - *low;
    }
    Eigen::Index axis = 0;
    way.cwiseAbs().maxCoeff(&axis);
    return way[axis] < 0.0 ? Vec3(-Vec3::Unit(axis)) : Vec3(Vec3::Unit(axis));
}

/// Where the pieces are on the ground when they are flat, in the scene, mm.
class Ground {
public:
    Ground(const FlattenResult& result, const Eigen::Quaterniond& upright) : result_(result) {
        for (const FlatRegion& flat : result.regions) {
            for (const Vec3& p : flat.region.positions) box_.extend(upright * p);
        }
    }
    [[nodiscard]] Vec3 place(std::size_t region, const Vec2& uv) const {
        const Vec2 on_sheet = result_.sheet.placements[region].apply(uv);
        return {box_.center().x() + on_sheet.x() - 0.5 * result_.sheet.width, box_.min().y(),
                box_.center().z() - on_sheet.y() + 0.5 * result_.sheet.height};
    }
    /// A mirrored piece lies with its inner side up.
    [[nodiscard]] Vec3 normal(std::size_t region) const {
        const double side = result_.sheet.placements[region].mirrored ? -1.0 : 1.0;
        return side * Vec3::UnitY();
    }

private:
    const FlattenResult& result_;
    Eigen::AlignedBox3d box_;
};

Points3 normals_of(const Region& region) {
    Points3 normals(region.positions.size(), Vec3::Zero());
    for (const Triangle& t : region.triangles) {
        const Vec3 normal = (region.position(t[1]) - region.position(t[0]))
                                .cross(region.position(t[2]) - region.position(t[0]));
        for (const Index v : t) normals[at(v)] += normal;
    }
    for (Vec3& normal : normals) normal = normal.norm() > 0.0 ? normal.normalized() : Vec3::UnitY();
    return normals;
}

/// The primitive of a region; what turns the model upright is undone for the flat place.
Json primitive(const FlattenResult& result, std::size_t r, const Ground& ground,
               const Eigen::Quaterniond& upright, GlbContainer& glb) {
    const auto& [region, chart] = std::tie(result.regions[r].region, result.regions[r].chart);
    Points2 texture;
    Points3 positions, moved, turned;
    const Points3 normals = normals_of(region);
    const Vec3 flat_normal = upright.inverse() * ground.normal(r);
    for (std::size_t v = 0; v < chart.uv.size(); ++v) {
        const Vec2 placed = result.sheet.placements[r].apply(chart.uv[v]);
        texture.emplace_back(placed.x() / result.sheet.width,
                             1.0 - placed.y() / result.sheet.height);
        positions.push_back(region.positions[v] / metre);
        const Vec3 flat = upright.inverse() * ground.place(r, chart.uv[v]);
        moved.push_back((flat - region.positions[v]) / metre);
        turned.push_back(flat_normal - normals[v]);
    }
    return {{"attributes",
             {{"POSITION", glb.add_positions(positions)},
              {"NORMAL", glb.add_directions(normals)},
              {"TEXCOORD_0", glb.add_texture_coordinates(texture)}}},
            {"indices", glb.add_indices(region.triangles)},
            {"material", 0},
            {"targets", Json::array({{{"POSITION", glb.add_positions(moved)},
                                      {"NORMAL", glb.add_directions(turned)}}})}};
}

/// From the last to the sheet in two seconds, and a second there.
Json flattening(std::size_t pieces, GlbContainer& glb) {
    Json channels = Json::array();
    for (std::size_t r = 0; r < pieces; ++r)
        channels.push_back({{"sampler", 0}, {"target", {{"node", r}, {"path", "weights"}}}});
    const auto times = glb.add_scalars({0.0, 2.0, 3.0});
    return {{"name", "flatten"},
            {"samplers",
             Json::array({{{"input", times}, {"output", glb.add_scalars({0.0, 1.0, 1.0})}}})},
            {"channels", std::move(channels)}};
}

}  // namespace

std::string write_flat_glb(const FlattenResult& result) {
    GlbContainer glb;
    Json& document = glb.document();
    document["asset"]["extras"] = {{"sheet_mm", {result.sheet.width, result.sheet.height}}};
    document["materials"].push_back(
        {{"name", "leather"},
         {"doubleSided", true},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", {0.8, 0.65, 0.5, 1.0}}, {"metallicFactor", 0.0}}}});
    const auto upright = Eigen::Quaterniond::FromTwoVectors(up_of(result), Vec3::UnitY());
    const Ground ground(result, upright);
    Json pieces = Json::array();
    for (std::size_t r = 0; r < result.regions.size(); ++r) {
        const std::string& name = result.regions[r].region.name;
        document["meshes"].push_back(
            {{"name", name},
             {"primitives", Json::array({primitive(result, r, ground, upright, glb)})},
             {"weights", Json::array({0.0})},
             {"extras", {{"targetNames", Json::array({"flat"})}}}});
        document["nodes"].push_back({{"name", name}, {"mesh", r}});
        pieces.push_back(r);
    }
    document["animations"] = Json::array({flattening(result.regions.size(), glb)});
    document["nodes"].push_back({{"name", "last"},
                                 {"rotation", {upright.x(), upright.y(), upright.z(), upright.w()}},
                                 {"children", pieces}});
    document["scenes"].push_back({{"nodes", Json::array({result.regions.size()})}});
    return glb.write();
}

}  // namespace lastflat
