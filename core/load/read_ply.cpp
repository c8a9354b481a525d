#include "core/load/read_ply.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>

#include "core/load/byte_order.h"
#include "core/load/text_scanner.h"
#include "core/load/triangulate_polygon.h"
#include "core/text.h"

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

/// Where the numbers of the body come from.
class Source {
public:
    virtual ~Source() = default;
    virtual double next(Scalar type) = 0;
    /// After the last value of an item.
    virtual void end_item() = 0;
    /// Bytes that are left: no element can be shorter than one a property.
    [[nodiscard]] virtual std::size_t left() const = 0;
    /// What stands in every message: the format, and the line if there are any.
    [[nodiscard]] virtual std::string place() const = 0;

    [[noreturn]] void fail(const std::string& what,
                           ErrorCode code = ErrorCode::unreadable_model) const {
        throw Error(code, place() + ": " + what);
    }
};

class TextSource final : public Source {
public:
    explicit TextSource(const TextScanner& scanner) : scanner_(scanner) {}
    double next(Scalar) override { return scanner_.next_number(); }
    void end_item() override {
        const std::string_view more = scanner_.peek_line();
        if (!more.empty())
            fail("'" + std::string(more.substr(0, 40)) +
                 "' is left over behind the values that the header announces");
        (void)scanner_.at_end();
    }
    [[nodiscard]] std::size_t left() const override { return scanner_.rest().size(); }
    [[nodiscard]] std::string place() const override {
        return "PLY line " + std::to_string(scanner_.line());
    }

private:
    TextScanner scanner_;
};

class BinarySource final : public Source {
public:
    BinarySource(std::string_view bytes, ByteOrder order) : rest_(bytes), order_(order) {}
    double next(Scalar type) override {
        const std::size_t size = size_of(type);
        if (rest_.size() < size) fail("the file ends before its last element");
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
    void end_item() override {}
    [[nodiscard]] std::size_t left() const override { return rest_.size(); }
    [[nodiscard]] std::string place() const override { return "PLY"; }

private:
    std::string_view rest_;
    ByteOrder order_;
};

class PlyReader {
public:
    PlyReader(std::string_view bytes, const LoadLimits& limits)
        : scanner_(bytes, "PLY"),
          limits_(limits),
          line_end_(bytes.substr(3, 1) == "\r" && bytes.substr(4, 1) != "\n" ? '\r' : '\n') {}

    RawMesh read() {
        const auto source = read_header();
        mesh_.label_sets.emplace_back();
        for (const Element& element : elements_) read_element(element, *source);
        if (mesh_.positions.empty()) source->fail("no element 'vertex'");
        split_polygons();
        if (mesh_.triangles.empty()) source->fail("no face; points have no surface");
        if (source->left() > 0)
            mesh_.warnings.push_back({"trailing_bytes",
                                      source->place() + ": " + std::to_string(source->left()) +
                                          " bytes follow the last element that the header "
                                          "announces; they were passed over",
                                      std::nullopt});
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
                break;
            } else {
                (void)scanner_.rest_of_line();  // comment, obj_info
            }
        }
        count_vertices();
        if (format == "ascii") {
            (void)scanner_.rest_of_line();
            return std::make_unique<TextSource>(scanner_);
        }
        if (format == "binary_little_endian")
            return std::make_unique<BinarySource>(binary_body(), ByteOrder::little);
        if (format == "binary_big_endian")
            return std::make_unique<BinarySource>(binary_body(), ByteOrder::big);
        scanner_.fail("the format '" + format.substr(0, 40) + "' is not known",
                      ErrorCode::unsupported_model);
    }

    void count_vertices() {
        for (const Element& element : elements_) {
            if (element.name != "vertex" || element.properties.empty()) continue;
            if (element.count > limits_.vertices - vertices_)
                scanner_.fail(std::to_string(element.count) + " vertices; at most " +
                                  std::to_string(limits_.vertices) + " are read",
                              ErrorCode::model_too_large);
            vertices_ += element.count;
        }
    }

    /// Behind the line of `end_header`. Where lines end with CR alone, a LF that follows is data.
    [[nodiscard]] std::string_view binary_body() const {
        std::string_view body = scanner_.rest();
        body.remove_prefix(std::min(body.find(line_end_), body.size()));
        return body.substr(std::min<std::size_t>(body.size(), 1));
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
            source.fail("the element '" + element.name.substr(0, 40) + "' announces " +
                        std::to_string(element.count) + " items, and " +
                        std::to_string(source.left()) + " bytes are left");
        if (element.name == "vertex") return read_vertices(element, source);
        const bool are_faces = element.name == "face", are_strips = element.name == "tristrips";
        for (std::uint64_t i = 0; i < element.count; ++i) {
            for (const Property& property : element.properties) {
                const bool corners =
                    (are_faces || are_strips) && property.count_type &&
                    (property.name == "vertex_indices" || property.name == "vertex_index");
                if (!corners) {
                    (void)read_value(property, source);
                } else if (are_faces) {
                    read_face(property, source);
                } else {
                    read_strips(property, source);
                }
            }
            source.end_item();
        }
    }

    void read_vertices(const Element& element, Source& source) {
        std::array<std::size_t, 3> properties{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            properties[axis] = element.properties.size();
            for (std::size_t p = 0; p < element.properties.size(); ++p) {
                if (element.properties[p].name == std::string(1, static_cast<char>('x' + axis)))
                    properties[axis] = p;
            }
            if (properties[axis] == element.properties.size())
                source.fail("the vertices have no property '" +
                            std::string(1, static_cast<char>('x' + axis)) + "'");
        }
        for (std::uint64_t i = 0; i < element.count; ++i) {
            Vec3 position = Vec3::Zero();
            for (std::size_t p = 0; p < element.properties.size(); ++p) {
                const double value = read_value(element.properties[p], source);
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    if (properties[axis] == p) position[static_cast<Eigen::Index>(axis)] = value;
                }
            }
            if (!position.allFinite())
                source.fail("vertex " + std::to_string(i) + " is not finite",
                            ErrorCode::mesh_degenerate);
            mesh_.positions.push_back(position);
            source.end_item();
        }
    }

    static double read_count(const Property& property, Source& source) {
        const double count = source.next(*property.count_type);
        if (!(count >= 0.0) || count > static_cast<double>(source.left()))
            source.fail("a list is longer than the file");
        return count;
    }

    /// The last value read.
    static double read_value(const Property& property, Source& source) {
        if (!property.count_type) return source.next(property.type);
        const double count = read_count(property, source);
        double value = 0.0;
        for (double i = 0.0; i < count; ++i) value = source.next(property.type);
        return value;
    }

    void read_face(const Property& property, Source& source) {
        const double count = read_count(property, source);
        if (count < 3.0) source.fail("a face has fewer than three corners");
        if (count > static_cast<double>(limits_.polygon_corners))
            source.fail(
                "a face has more than " + std::to_string(limits_.polygon_corners) + " corners",
                ErrorCode::model_too_large);
        for (double i = 0.0; i < count; ++i)
            used_.push_back(corner(source.next(property.type), source));
        end_polygon(source);
    }

    /// Strips, with -1 between them; of every second triangle the winding is turned.
    void read_strips(const Property& property, Source& source) {
        const double count = read_count(property, source);
        strip_values_ += count;
        if (strip_values_ > 4.0 * static_cast<double>(limits_.triangles))
            source.fail("the strips are too long", ErrorCode::model_too_large);
        Index before_last = 0, last = 0;
        std::size_t length = 0;
        for (double i = 0.0; i < count; ++i) {
            const double value = source.next(property.type);
            if (value == -1.0) {
                length = 0;
                continue;
            }
            const Index next = corner(value, source);
            const bool repeats = before_last == last || last == next || next == before_last;
            if (length >= 2 && !repeats) {
                const bool odd = length % 2 == 1;
                used_.insert(used_.end(),
                             {odd ? last : before_last, odd ? before_last : last, next});
                end_polygon(source);
            }
            before_last = last;
            last = next;
            ++length;
        }
    }

    void end_polygon(const Source& source) {
        const std::size_t begin = ends_.empty() ? 0 : ends_.back();
        triangles_ += used_.size() - begin - 2;
        ends_.push_back(used_.size());
        if (triangles_ > limits_.triangles)
            source.fail("more than " + std::to_string(limits_.triangles) + " triangles",
                        ErrorCode::model_too_large);
    }

    [[nodiscard]] Index corner(double value, const Source& source) const {
        if (!(value >= 0.0)) source.fail("a face names a vertex that does not exist");
        if (value >= static_cast<double>(vertices_))
            source.fail("a face names vertex " + fixed_text(value, 0) + " of " +
                        std::to_string(vertices_));
        return static_cast<Index>(value);
    }

    void split_polygons() {
        std::size_t begin = 0;
        for (const std::size_t end : ends_) {
            const std::span<const Index> corners(used_.data() + begin, end - begin);
            begin = end;
            for (const Triangle& triangle : triangulate_polygon(mesh_.positions, corners)) {
                mesh_.triangles.push_back(triangle);
                mesh_.triangle_labels.push_back(0);
            }
        }
    }

    static constexpr std::size_t most_parts = 256;
    TextScanner scanner_;
    const LoadLimits& limits_;
    char line_end_;  ///< the last character of the header's lines
    std::vector<Element> elements_;
    std::size_t vertices_ = 0;   ///< that the header announces
    std::size_t triangles_ = 0;  ///< of all polygons
    double strip_values_ = 0.0;
    std::vector<Index> used_;        ///< corners of all polygons, one after the other
    std::vector<std::size_t> ends_;  ///< where each polygon's corners end
    RawMesh mesh_;
};

}  // namespace

RawMesh read_ply(std::string_view bytes, const LoadLimits& limits) {
    return PlyReader(bytes, limits).read();
}

}  // namespace lastflat
