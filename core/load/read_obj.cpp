#include "core/load/read_obj.h"

#include <charconv>
#include <cmath>
#include <map>

#include "core/load/text_scanner.h"
#include "core/load/triangulate_polygon.h"
#include "core/utf8.h"

namespace lastflat {
namespace {

class ObjReader {
public:
    ObjReader(std::string_view text, const LoadLimits& limits) : rest_(text), limits_(limits) {}

    RawMesh read() {
        while (!rest_.empty()) read_statement(next_statement());
        if (mesh_.positions.empty()) fail("no vertex (`v` line): is this an OBJ file?");
        if (mesh_.triangles.empty()) fail("no face (`f` line); points and lines have no surface");
        return std::move(mesh_);
    }

private:
    [[noreturn]] void fail(const std::string& what,
                           ErrorCode code = ErrorCode::unreadable_model) const {
        throw Error(code, "OBJ line " + std::to_string(line_) + ": " + what);
    }

    static std::string quoted(std::string_view word) {
        std::string text = "'";
        text.append(word.substr(0, 40));
        text += '\'';
        return text;
    }

    std::string_view next_line() {
        ++line_;
        return take_line(rest_);
    }

    /// One logical line: a backslash at the end joins it with the next.
    std::string_view next_statement() {
        std::string_view line = next_line();
        if (line.empty() || line.back() != '\\') return line;
        joined_.clear();
        while (!line.empty() && line.back() == '\\') {
            joined_.append(line.substr(0, line.size() - 1)).push_back(' ');
            line = next_line();
        }
        joined_.append(line);
        return joined_;
    }

    static std::string_view next_word(std::string_view& line) {
        const auto begin = line.find_first_not_of(" \t");
        if (begin == std::string_view::npos) {
            line = {};
            return {};
        }
        line.remove_prefix(begin);
        const auto word = line.substr(0, line.find_first_of(" \t"));
        line.remove_prefix(word.size());
        return word;
    }

    void read_statement(std::string_view line) {
        const auto keyword = next_word(line);
        if (keyword == "v") {
            read_vertex(line);
        } else if (keyword == "f" || keyword == "fo") {
            read_face(line);
        } else if (keyword == "l") {
            read_line(line);
        } else if (keyword == "g") {
            groups_ = read_names(line);
            labels_changed_ = true;
        } else if (keyword == "o") {
            object_ = read_whole_name(line);
            labels_changed_ = true;
        } else if (keyword == "usemtl") {
            material_ = read_whole_name(line);
            labels_changed_ = true;
        } else if (keyword == "call" || keyword == "csh") {
            fail(quoted(keyword) + " would open another file or run a command",
                 ErrorCode::unsupported_model);
        }
    }

    double read_number(std::string_view word) const {
        if (!word.empty() && word.front() == '+') word.remove_prefix(1);
        double value = 0.0;
        const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (status != std::errc() || end != word.data() + word.size()) {
            fail(quoted(word) + " is not a number");
        }
        if (!std::isfinite(value)) fail("a coordinate is not finite");
        return value;
    }

    void read_vertex(std::string_view line) {
        if (mesh_.positions.size() >= limits_.vertices) too_large("vertices", limits_.vertices);
        Vec3 position;
        for (Eigen::Index i = 0; i < 3; ++i) {
            const auto word = next_word(line);
            if (word.empty()) fail("a vertex needs three coordinates");
            position[i] = read_number(word);
        }
        mesh_.positions.push_back(position);
    }

    Index read_corner(std::string_view word) const {
        const auto number = word.substr(0, word.find('/'));
        std::int64_t id = 0;
        const auto [end, status] =
            std::from_chars(number.data(), number.data() + number.size(), id);
        if (status != std::errc() || end != number.data() + number.size()) {
            fail(quoted(word) + " is not a vertex of a face");
        }
        const auto count = static_cast<std::int64_t>(mesh_.positions.size());
        const std::int64_t index = id > 0 ? id - 1 : count + id;
        if (id == 0 || index < 0 || index >= count) {
            fail("vertex " + std::to_string(id) + " does not exist (" + std::to_string(count) +
                 " vertices so far, counted from 1)");
        }
        return static_cast<Index>(index);
    }

    void read_face(std::string_view line) {
        corners_.clear();
        for (auto word = next_word(line); !word.empty(); word = next_word(line)) {
            if (corners_.size() >= limits_.polygon_corners) {
                too_large("corners of a face", limits_.polygon_corners);
            }
            corners_.push_back(read_corner(word));
        }
        if (corners_.size() < 3) fail("a face needs three vertices");
        const auto triangles = triangulate_polygon(mesh_.positions, corners_);
        if (mesh_.triangles.size() + triangles.size() > limits_.triangles) {
            too_large("triangles", limits_.triangles);
        }
        const std::uint32_t labels = current_labels();
        for (const Triangle& triangle : triangles) {
            mesh_.triangles.push_back(triangle);
            mesh_.triangle_labels.push_back(labels);
        }
    }

    void read_line(std::string_view line) {
        RawMesh::Line path{current_names(), {}};
        for (auto word = next_word(line); !word.empty(); word = next_word(line)) {
            if (++line_corners_ > limits_.vertices) too_large("corners of lines", limits_.vertices);
            path.vertices.push_back(read_corner(word));
        }
        if (mesh_.lines.size() >= limits_.lines) too_large("lines", limits_.lines);
        if (path.vertices.size() > 1) mesh_.lines.push_back(std::move(path));
    }

    std::vector<std::string> current_names() const {
        std::vector<std::string> names = groups_;
        if (!object_.empty()) names.push_back(object_);
        if (!material_.empty()) names.push_back(material_);
        return names;
    }

    std::string checked_name(std::string_view name) const {
        if (name.size() > limits_.name_bytes) too_large("bytes of a name", limits_.name_bytes);
        return as_utf8(name);
    }

    std::vector<std::string> read_names(std::string_view line) const {
        std::vector<std::string> names;
        for (auto word = next_word(line); !word.empty(); word = next_word(line)) {
            if (names.size() >= limits_.face_names) {
                too_large("names of a face", limits_.face_names);
            }
            names.push_back(checked_name(word));
        }
        return names;
    }

    std::string read_whole_name(std::string_view line) const {
        const auto begin = line.find_first_not_of(" \t");
        if (begin == std::string_view::npos) return {};
        return checked_name(line.substr(begin, line.find_last_not_of(" \t") + 1 - begin));
    }

    std::uint32_t current_labels() {
        if (!labels_changed_) return labels_;
        std::vector<std::string> names = current_names();
        const auto next = static_cast<std::uint32_t>(mesh_.label_sets.size());
        const auto [found, is_new] = known_labels_.try_emplace(names, next);
        if (is_new) {
            if (mesh_.label_sets.size() >= limits_.name_sets) {
                too_large("groups", limits_.name_sets);
            }
            mesh_.label_sets.push_back(std::move(names));
        }
        labels_ = found->second;
        labels_changed_ = false;
        return labels_;
    }

    [[noreturn]] void too_large(const char* what, std::size_t limit) const {
        fail("more than " + std::to_string(limit) + " " + what, ErrorCode::model_too_large);
    }

    std::string_view rest_;
    LoadLimits limits_;
    RawMesh mesh_;
    std::size_t line_ = 0;
    std::string joined_;
    std::vector<Index> corners_;
    std::vector<std::string> groups_;
    std::string object_, material_;
    std::map<std::vector<std::string>, std::uint32_t> known_labels_;
    std::uint32_t labels_ = 0;
    std::size_t line_corners_ = 0;
    bool labels_changed_ = true;
};

}  // namespace

RawMesh read_obj(std::string_view text, const LoadLimits& limits) {
    return ObjReader(text, limits).read();
}

}  // namespace lastflat
