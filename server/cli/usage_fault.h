// What is wrong with the arguments of the program.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace lastflat::server {

/// A sentence, with the nearest name of a command or an option that does not exist.
[[nodiscard]] std::string usage_fault(const CLI::App& app, const CLI::ParseError& error);

}  // namespace lastflat::server
