#include "api/object_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lastflat::api {

namespace {

/// A value takes sixteen bytes of memory, a list or an object ten times as many, and may take two
/// of text.
constexpr std::size_t most_values = 4'000'000;
/// Of text beside what stands in strings, such as a model in base64.
constexpr std::size_t most_bytes = std::size_t{32} << 20;

/// Goes through a document without keeping it, and throws InvalidRequest at the first thing that
/// breaks its limits.
class Inspector : public nlohmann::json_sax<nlohmann::json> {
public:
    Inspector(std::size_t bytes, int depth) : bytes_(bytes), depth_(depth) {}

    bool null() override { return count(); }
    bool boolean(bool) override { return count(); }
    bool number_integer(number_integer_t) override { return count(); }
    bool number_unsigned(number_unsigned_t) override { return count(); }
    bool number_float(number_float_t, const string_t&) override { return count(); }
    bool binary(binary_t&) override { return count(); }
    bool string(string_t& text) override {
        in_strings_ += text.size();
        return count();
    }
    bool start_object(std::size_t) override {
        names_.emplace_back();
        return open();
    }
    bool start_array(std::size_t) override { return open(); }
    bool end_object() override {
        names_.pop_back();
        return close();
    }
    bool end_array() override { return close(); }
    bool key(string_t& name) override {
        if (!names_.back().insert(name).second)
            throw InvalidRequest(
                "", "the name '" + name.substr(0, 80) + "' stands twice in one object");
        return count();
    }
    bool parse_error(std::size_t, const std::string&,
                     const nlohmann::json::exception& error) override {
        // "[json.exception.parse_error.101] parse error at line ..."
        std::string what = error.what();
        if (const auto end = what.find("] "); end != std::string::npos) what.erase(0, end + 2);
        // The library quotes what it read last, which may be bytes that no JSON can carry back.
        what = what.substr(0, what.find("; last read"));
        throw InvalidRequest("", "the JSON cannot be read: " + what);
    }

    void check_bytes() const {
        if (bytes_ - std::min(bytes_, in_strings_) > most_bytes)
            throw InvalidRequest("", "the JSON has more than " + std::to_string(most_bytes) +
                                         " bytes beside its texts");
    }

private:
    bool count() {
        if (++values_ > most_values)
            throw InvalidRequest("", "the JSON has more than " + std::to_string(most_values) +
                                         " values, names, lists and objects");
        return true;
    }
    bool open() {
        if (++level_ > depth_)
            throw InvalidRequest(
                "", "the JSON is nested deeper than " + std::to_string(depth_) + " levels");
        return count();
    }
    bool close() {
        --level_;
        return true;
    }

    std::size_t bytes_;
    int depth_, level_ = 0;
    std::size_t values_ = 0, in_strings_ = 0;
    std::vector<std::set<std::string>> names_;  // of the objects that are open
};

}  // namespace

nlohmann::json parse_json(std::string_view text, int depth) {
    Inspector inspector(text.size(), depth);
    nlohmann::json::sax_parse(text.begin(), text.end(), &inspector);
    inspector.check_bytes();
    return nlohmann::json::parse(text.begin(), text.end());
}

std::string step(const std::string& pointer, const std::string& name) {
    std::string result = pointer + "/";
    for (const char c : name) {
        if (c == '~')
            result += "~0";
        else if (c == '/')
            result += "~1";
        else
            result += c;
    }
    return result;
}

std::string Field::text(std::size_t bytes) const {
    if (!value.is_string()) fail("must be a text");
    auto text = value.get<std::string>();
    if (text.empty() || text.size() > bytes) {
        fail("must have 1 to " + std::to_string(bytes) + " bytes");
    }
    for (const char c : text) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F)
            fail("must not have control characters");
    }
    return text;
}

double Field::number(double least, double most) const {
    if (!value.is_number()) fail("must be a number");
    const auto number = value.get<double>();
    if (!(number >= least && number <= most)) {
        fail("must lie between " + nlohmann::json(least).dump() + " and " +
             nlohmann::json(most).dump());
    }
    return number;
}

std::int32_t Field::index() const {
    constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
    // A number above 2^63 is kept unsigned by the reader; comparing it as such keeps it too large.
    const bool whole = value.is_number_unsigned()
                           ? value.get<std::uint64_t>() <= static_cast<std::uint64_t>(most)
                           : value.is_number_integer() && value.get<std::int64_t>() >= 0;
    if (!whole) fail("must be a vertex id: a whole number from 0");
    return static_cast<std::int32_t>(value.get<std::int64_t>());
}

std::vector<Field> Field::items(std::size_t most) const {
    if (!value.is_array()) fail("must be a list");
    if (value.size() > most) fail("must have at most " + std::to_string(most) + " items");
    std::vector<Field> fields;
    fields.reserve(value.size());
    for (std::size_t i = 0; i < value.size(); ++i) {
        fields.push_back({value[i], pointer + "/" + std::to_string(i)});
    }
    return fields;
}

std::vector<std::pair<std::string, Field>> Field::entries(std::size_t most) const {
    if (!value.is_object()) fail("must be an object");
    if (value.size() > most) fail("must have at most " + std::to_string(most) + " entries");
    std::vector<std::pair<std::string, Field>> fields;
    for (const auto& [name, member] : value.items()) {
        const nlohmann::json as_value = name;
        const Field checked{as_value, step(pointer, name)};
        fields.emplace_back(checked.text(128), Field{member, step(pointer, name)});
    }
    return fields;
}

ObjectReader::ObjectReader(Field field) : field_(std::move(field)) {
    if (!field_.value.is_object()) field_.fail("must be an object");
}

std::optional<Field> ObjectReader::find(const std::string& name) {
    known_.insert(name);
    const auto found = field_.value.find(name);
    if (found == field_.value.end()) return std::nullopt;
    return Field{*found, step(field_.pointer, name)};
}

void ObjectReader::finish() const {
    for (const auto& [name, member] : field_.value.items()) {
        if (known_.count(name) == 0) fail_unknown(name);
    }
}

void ObjectReader::fail_unknown(const std::string& name) const {
    std::string list;
    for (const auto& word : known_) list += (list.empty() ? "" : ", ") + word;
    const std::string nearest = suggestion(name, {known_.begin(), known_.end()});
    throw InvalidRequest(
        step(field_.pointer, name),
        "unknown field" + nearest + (nearest.empty() ? "; known" : " Known") + " here: " + list);
}

}  // namespace lastflat::api
