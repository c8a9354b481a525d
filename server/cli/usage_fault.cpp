#include "server/cli/usage_fault.h"

#include <vector>

#include "api/nearest_name.h"

namespace lastflat::server {
namespace {

std::vector<std::string> commands_of(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(command->get_name());
    return names;
}

std::vector<std::string> options_of(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    return names;
}

std::string listed(const std::vector<std::string>& names) {
    std::string list;
    for (const std::string& name : names) list.append(list.empty() ? "" : ", ").append(name);
    return list;
}

}  // namespace

std::string usage_fault(const CLI::App& app, const CLI::ParseError& error) {
    const CLI::App* command = &app;
    std::string path;  // from the program to the command
    while (!command->get_subcommands().empty()) {
        command = command->get_subcommands().front();
        path += (path.empty() ? "" : " ") + command->get_name();
    }
    const std::vector<std::string> commands = commands_of(*command);
    const std::string help = "; see lastflat " + path + (path.empty() ? "" : " ") + "--help";
    const std::vector<std::string> unknown = app.remaining(true);
    if (!unknown.empty()) {
        const std::string& word = unknown.front();
        if (word.rfind('-', 0) == 0) {
            const std::string name = word.substr(0, word.find('='));
            const std::string nearest = api::suggestion(name, options_of(*command));
            return "there is no option '" + name + "' of '" + path + "'" +
                   (nearest.empty() ? help : nearest);
        }
        if (commands.empty()) return "'" + path + "' does not take '" + word + "'" + help;
        const std::string nearest = api::suggestion(word, commands);
        return "there is no command '" + word + "'" +
               (nearest.empty() ? "; there are: " + listed(commands) : nearest);
    }
    if (!commands.empty()) return "which command? There are: " + listed(commands);
    const std::string fault = error.what();
    return fault + (fault.ends_with('?') ? "" : help);
}

}  // namespace lastflat::server
