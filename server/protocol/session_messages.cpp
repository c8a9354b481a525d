#include "server/protocol/session_messages.h"

#include <istream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace lastflat::server {

using Json = nlohmann::ordered_json;

namespace {

constexpr std::size_t longest_line = 1u << 20;
constexpr std::size_t longest_body = 1u << 30;

}  // namespace

std::string to_bytes(const SessionAsk& ask) {
    const Json json{{"number", ask.number},
                    {"kind", ask.kind},
                    {"sequence", ask.sequence},
                    {"points", ask.points},
                    {"bytes", ask.text.size()}};
    return json.dump() + "\n" + ask.text;
}

std::optional<SessionAsk> read_session_ask(std::istream& from) {
    std::string line;
    if (!std::getline(from, line)) return std::nullopt;
    const auto json = Json::parse(line);
    SessionAsk ask{json.at("number"), json.at("kind"), json.at("sequence"), json.at("points")};
    ask.text.resize(json.at("bytes"));
    if (!from.read(ask.text.data(), static_cast<std::streamsize>(ask.text.size())))
        return std::nullopt;
    return ask;
}

std::string to_bytes(const SessionAnswer& answer) {
    Json json{{"number", answer.number}};
    if (answer.problem)
        json["problem"] = Json::parse(api::to_json(*answer.problem));
    else
        json["bytes"] = answer.body.size();
    return json.dump(-1, ' ', true) + "\n" + answer.body;
}

std::optional<SessionAnswer> take_session_answer(std::string& read) {
    const std::size_t end = read.find('\n');
    if (end == std::string::npos) {
        if (read.size() > longest_line) throw std::runtime_error("an endless line");
        return std::nullopt;
    }
    const auto json = Json::parse(std::string_view(read).substr(0, end));
    SessionAnswer answer{json.at("number")};
    std::size_t bytes = 0;
    if (json.contains("problem"))
        answer.problem = api::problem_from_json(json["problem"].dump());
    else
        bytes = json.at("bytes");
    if (bytes > longest_body) throw std::runtime_error("an endless body");
    if (read.size() - end - 1 < bytes) return std::nullopt;
    answer.body = read.substr(end + 1, bytes);
    read.erase(0, end + 1 + bytes);
    return answer;
}

}  // namespace lastflat::server
