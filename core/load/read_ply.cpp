#include "core/load/read_ply.h"

#include <array>
#include <limits>
#include <memory>
#include <optional>

#include "core/load/byte_order.h"
#include "core/load/text_scanner.h"
#include "core/load/triangulate_polygon.h"

namespace lastflat {
namespace {

enum class Scalar { i8, u8, i16, u16, i32, u32, f32, f64 };

struct Property {
    std::string name;
    Scalar type = Scalar::f32;
    std::optional<Scalar> count_type;  ///< of a list
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
};

std::size_t size_of(Scalar type) {
    switch (type) {
        case Scalar::i8:
        case Scalar::u8: return 1;
        case Scalar::i16:
        case Scalar::u16: return 2;
        case Scalar::i32:
        case Scalar::u32:
        case Scalar::f32: return 4;
        case Scalar::f64: return 8;
    }
    return 8;
}

[[noreturn]] void fail_ply(const std::string& what, ErrorCode code = ErrorCode::unreadable_model) {
    throw Error(code, "PLY: " + what);
}

/// Where the numbers of the body come from.
class Source {
public:
    virtual ~Source() = default;
    virtual double next(Scalar type) = 0;
    /// Bytes that are left: no element can be shorter than one a property.
    [[nodiscard]] virtual std::size_t left() const = 0;
};

class TextSource final : public Source {
public:
    explicit TextSource(const TextScanner& scanner) : scanner_(scanner) {}
    double next(Scalar) override { return scanner_.next_number(); }
    [[nodiscard]] std::size_t left() const override { return scanner_.rest().size(); }

private:
    TextScanner scanner_;
};

class BinarySource final : public Source {
public:
    BinarySource(std::string_view bytes, ByteOrder order) : rest_(bytes), order_(order) {}
    double next(Scalar type) override {
        const std::size_t size = size_of(type);
        if (rest_.size() < size) fail_ply("the file ends before its last element");
        const std::string_view at = rest_;
        rest_.remove_prefix(size);
        switch (type) {
            case Scalar::i8: return static_cast<std::int8_t>(at[0]);
            case Scalar::u8: return static_cast<std::uint8_t>(at[0]);
            case Scalar::i16:
                return static_cast<std::int16_t>(read_unsigned<std::uint16_t>(at, order_));
            case Scalar::u16: return read_unsigned<std::uint16_t>(at, order_);
            case Scalar::i32:
                return static_cast<std::int32_t>(read_unsigned<std::uint32_t>(at, order_));
            case Scalar::u32: return read_unsigned<std::uint32_t>(at, order_);
            case Scalar::f32: return static_cast<double>(read_float<float>(at, order_));
            case Scalar::f64: return read_float<double>(at, order_);
        }
        return 0.0;
    }
    [[nodiscard]] std::size_t left() const override { return rest_.size(); }

private:
    std::string_view rest_;
    ByteOrder order_;
};

class PlyReader {
public:
    PlyReader(std::string_view bytes, const LoadLimits& limits)
        : scanner_(bytes, "PLY"), limits_(limits) {}

    RawMesh read() {
        const auto source = read_header();
        mesh_.label_sets.emplace_back();
        for (const Element& element : elements_) read_element(element, *source);
        for (const Index corner : used_) {
            if (corner >= static_cast<Index>(mesh_.positions.size()))
                fail_ply("a face names vertex " + std::to_string(corner) + " of " +
                         std::to_string(mesh_.positions.size()));
        }
        if (mesh_.positions.empty()) fail_ply("no element 'vertex'");
        split_polygons();
        if (mesh_.triangles.empty()) fail_ply("no face; points have no surface");
        return std::move(mesh_);
    }

private:
    Scalar scalar(std::string_view word) const {
        constexpr std::array<std::pair<std::string_view, Scalar>, 16> words{
            {{"char", Scalar::i8},
             {"int8", Scalar::i8},
             {"uchar", Scalar::u8},
             {"uint8", Scalar::u8},
             {"short", Scalar::i16},
             {"int16", Scalar::i16},
             {"ushort", Scalar::u16},
             {"uint16", Scalar::u16},
             {"int", Scalar::i32},
             {"int32", Scalar::i32},
             {"uint", Scalar::u32},
             {"uint32", Scalar::u32},
             {"float", Scalar::f32},
             {"float32", Scalar::f32},
             {"double", Scalar::f64},
             {"float64", Scalar::f64}}};
        for (const auto& [name, type] : words) {
            if (name == word) return type;
        }
        scanner_.fail("'" + std::string(word.substr(0, 40)) + "' is no type of a property");
    }

    std::unique_ptr<Source> read_header() {
        std::string format;
        (void)scanner_.rest_of_line();  // "ply"
        for (;;) {
            const std::string_view word = scanner_.next_word();
            if (word.empty()) scanner_.fail("the header has no end");
            if (word == "format") {
                format = scanner_.next_word();
                (void)scanner_.rest_of_line();
            } else if (word == "element") {
                if (elements_.size() >= most_parts) scanner_.fail("too many elements");
                elements_.push_back({std::string(scanner_.next_word()), scanner_.next_count(), {}});
            } else if (word == "property") {
                read_property();
            } else if (word == "end_header") {
                (void)scanner_.rest_of_line();
                break;
            } else {
                (void)scanner_.rest_of_line();  // comment, obj_info
            }
        }
        if (format == "ascii") return std::make_unique<TextSource>(scanner_);
        if (format == "binary_little_endian")
            return std::make_unique<BinarySource>(scanner_.rest(), ByteOrder::little);
        if (format == "binary_big_endian")
            return std::make_unique<BinarySource>(scanner_.rest(), ByteOrder::big);
        fail_ply("the format '" + format.substr(0, 40) + "' is not known",
                 ErrorCode::unsupported_model);
    }

    void read_property() {
        if (elements_.empty()) scanner_.fail("a property of no element");
        auto& properties = elements_.back().properties;
        if (properties.size() >= most_parts) scanner_.fail("too many properties");
        Property property;
        std::string_view word = scanner_.next_word();
        if (word == "list") {
            property.count_type = scalar(scanner_.next_word());
            word = scanner_.next_word();
        }
        property.type = scalar(word);
        property.name = scanner_.next_word();
        properties.push_back(std::move(property));
    }

    void read_element(const Element& element, Source& source) {
        if (element.properties.empty()) return;
        if (element.count > source.left())
            fail_ply("the element '" + element.name.substr(0, 40) + "' announces " +
                     std::to_string(element.count) + " items, and " +
                     std::to_string(source.left()) + " bytes are left");
        if (element.name == "vertex") {
            read_vertices(element, source);
            return;
        }
        for (std::uint64_t i = 0; i < element.count; ++i) {
            for (const Property& property : element.properties) {
                const bool corners =
                    element.name == "face" && property.count_type &&
                    (property.name == "vertex_indices" || property.name == "vertex_index");
                read_value(property, source, corners);
            }
        }
    }

    void read_vertices(const Element& element, Source& source) {
        if (element.count > limits_.vertices)
            fail_ply(std::to_string(element.count) + " vertices; at most " +
                         std::to_string(limits_.vertices) + " are read",
                     ErrorCode::model_too_large);
        std::array<std::size_t, 3> properties{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            properties[axis] = element.properties.size();
            for (std::size_t p = 0; p < element.properties.size(); ++p) {
                if (element.properties[p].name == std::string(1, static_cast<char>('x' + axis)))
                    properties[axis] = p;
            }
            if (properties[axis] == element.properties.size())
                fail_ply("the vertices have no property '" +
                         std::string(1, static_cast<char>('x' + axis)) + "'");
        }
        for (std::uint64_t i = 0; i < element.count; ++i) {
            Vec3 position = Vec3::Zero();
            for (std::size_t p = 0; p < element.properties.size(); ++p) {
                const double value = read_value(element.properties[p], source, false);
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    if (properties[axis] == p) position[static_cast<Eigen::Index>(axis)] = value;
                }
            }
            if (!position.allFinite())
                fail_ply("vertex " + std::to_string(i) + " is not finite",
                         ErrorCode::mesh_degenerate);
            mesh_.positions.push_back(position);
        }
    }

    /// The last value read; a list of corners becomes a polygon.
    double read_value(const Property& property, Source& source, bool corners) {
        if (!property.count_type) return source.next(property.type);
        const double count = source.next(*property.count_type);
        if (!(count >= 0.0) || count > static_cast<double>(source.left()))
            fail_ply("a list is longer than the file");
        if (corners && count > static_cast<double>(limits_.polygon_corners))
            fail_ply("a face has more than " + std::to_string(limits_.polygon_corners) + " corners",
                     ErrorCode::model_too_large);
        double value = 0.0;
        for (double i = 0.0; i < count; ++i) {
            value = source.next(property.type);
            if (corners) used_.push_back(corner(value));
        }
        if (corners) {
            ends_.push_back(used_.size());
            if (ends_.size() > limits_.triangles)
                fail_ply("more than " + std::to_string(limits_.triangles) + " faces",
                         ErrorCode::model_too_large);
        }
        return value;
    }

    static Index corner(double value) {
        if (!(value >= 0.0) || value > static_cast<double>(std::numeric_limits<Index>::max()))
            fail_ply("a face names a vertex that does not exist");
        return static_cast<Index>(value);
    }

    void split_polygons() {
        std::size_t begin = 0;
        for (const std::size_t end : ends_) {
            const std::span<const Index> corners(used_.data() + begin, end - begin);
            begin = end;
            if (corners.size() < 3) fail_ply("a face has fewer than three corners");
            for (const Triangle& triangle : triangulate_polygon(mesh_.positions, corners)) {
                mesh_.triangles.push_back(triangle);
                mesh_.triangle_labels.push_back(0);
            }
            if (mesh_.triangles.size() > limits_.triangles)
                fail_ply("more than " + std::to_string(limits_.triangles) + " triangles",
                         ErrorCode::model_too_large);
        }
    }

    static constexpr std::size_t most_parts = 256;
    TextScanner scanner_;
    const LoadLimits& limits_;
    std::vector<Element> elements_;
    std::vector<Index> used_;        ///< corners of all polygons, one after the other
    std::vector<std::size_t> ends_;  ///< where each polygon's corners end
    RawMesh mesh_;
};

}  // namespace

RawMesh read_ply(std::string_view bytes, const LoadLimits& limits) {
    return PlyReader(bytes, limits).read();
}

}  // namespace lastflat
