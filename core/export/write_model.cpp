#include "core/export/write_model.h"

#include <array>
#include <charconv>
#include <map>

#include "core/export/glb_container.h"
#include "core/text.h"

namespace lastflat {
namespace {

/// A line "v 1.5 2 3".
template <std::size_t count>
void append_line(std::string& text, const char* word, const std::array<double, count>& values,
                 std::chars_format format, int precision) {
    text += word;
    for (const double value : values) {
        text += ' ';
        append_number(text, value, format, precision);
    }
    text += '\n';
}

void append_integer(std::string& text, Index value) {
    std::array<char, 16> digits;
    text.append(digits.data(),
                std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

/// A name as one OBJ word.
std::string obj_word(std::string name) {
    for (char& c : name) {
        if (static_cast<unsigned char>(c) <= ' ' || c == '#') c = '_';
    }
    return name.empty() ? "_" : name;
}

Points3 in_metres(const Points3& millimetres) {
    Points3 metres;
    for (const Vec3& p : millimetres) metres.push_back(p / 1000.0);
    return metres;
}

/// The triangles of each label set, in the order of the sets.
std::map<std::uint32_t, std::vector<Triangle>> by_label(const RawMesh& mesh) {
    std::map<std::uint32_t, std::vector<Triangle>> groups;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        groups[mesh.triangle_labels[t]].push_back(mesh.triangles[t]);
    }
    return groups;
}

std::string group_name(const RawMesh& mesh, std::uint32_t label) {
    std::string name;
    for (const auto& word : mesh.label_sets[label])
        name += (name.empty() ? "" : " ") + obj_word(word);
    return name;
}

}  // namespace

std::string write_flat_obj(const FlattenResult& result) {
    std::string text = "# lastflat: v in mm on the last, vt in mm on the flat piece\n";
    Index offset = 1;
    for (const FlatRegion& flat : result.regions) {
        text += "g " + obj_word(flat.region.name).substr(0, 120) + "\n";
        for (const Vec3& p : flat.region.positions) {
            append_line(text, "v", std::array{p.x(), p.y(), p.z()}, std::chars_format::general, 13);
        }
        for (const Vec2& p : flat.chart.uv)
            append_line(text, "vt", std::array{p.x(), p.y()}, std::chars_format::general, 13);
        for (const Triangle& t : flat.region.triangles) {
            text += 'f';
            for (const Index corner : t) {
                text += ' ';
                append_integer(text, corner + offset);
                text += '/';
                append_integer(text, corner + offset);
            }
            text += '\n';
        }
        offset += static_cast<Index>(flat.region.positions.size());
    }
    return text;
}

std::string write_model_obj(const RawMesh& mesh) {
    std::string text = "# mm\n";
    for (const Vec3& p : mesh.positions)
        append_line(text, "v", std::array{p.x(), p.y(), p.z()}, std::chars_format::fixed, 4);
    for (const auto& [label, triangles] : by_label(mesh)) {
        text += "g " + group_name(mesh, label) + "\n";
        for (const Triangle& t : triangles) {
            text += 'f';
            for (const Index corner : t) {
                text += ' ';
                append_integer(text, corner + 1);
            }
            text += '\n';
        }
    }
    return text;
}

std::string write_model_glb(const RawMesh& mesh) {
    GlbContainer glb;
    auto& document = glb.document();
    const auto positions = glb.add_positions(in_metres(mesh.positions));
    auto primitives = nlohmann::ordered_json::array();
    document["materials"] = nlohmann::ordered_json::array();
    for (const auto& [label, triangles] : by_label(mesh)) {
        primitives.push_back({{"attributes", {{"POSITION", positions}}},
                              {"indices", glb.add_indices(triangles)},
                              {"material", document["materials"].size()}});
        document["materials"].push_back({{"name", group_name(mesh, label)}});
    }
    document["meshes"].push_back({{"name", "last"}, {"primitives", primitives}});
    document["nodes"].push_back({{"name", "last"}, {"mesh", 0}});
    document["scenes"].push_back({{"nodes", {0}}});
    return glb.write();
}

}  // namespace lastflat
