// Benchmarks: `bench tables|speed|scaling`, printed as Markdown.
#include "tests/bench/bench.h"

#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>

namespace {

/// Puts the text between the lines `<!-- bench: NAME -->` and `<!-- bench end -->` of a file.
bool write_between(const std::string& file, const std::string& name, const std::string& text) {
    std::ifstream in(file);
    std::string content{std::istreambuf_iterator<char>(in), {}};
    const std::string begin = "<!-- bench: " + name + " -->\n";
    const auto first = content.find(begin);
    if (first == std::string::npos) return false;
    const auto last = content.find("<!-- bench end -->", first);
    if (last == std::string::npos) return false;
    content.replace(first + begin.size(), last - first - begin.size(), text);
    std::ofstream(file) << content;
    return true;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Every method and its peers, in one run, as Markdown"};
    app.require_subcommand(1);
    std::string only, file;
    int runs = 5, largest = 1'000'000;
    auto* tables = app.add_subcommand("tables", "distortion and time of every method");
    tables->add_option("--only", only, "subjects whose name begins so");
    auto* speed = app.add_subcommand("speed", "the promised ratios against CGAL");
    auto* scaling = app.add_subcommand("scaling", "time and memory against size");
    scaling->add_option("--largest", largest, "triangles");
    for (auto* command : {tables, speed, scaling}) {
        command->add_option("--runs", runs, "per figure; the median is shown")
            ->check(CLI::Range(1, 100));
        command->add_option("--write", file, "a file with a marked place for the tables");
    }
    CLI11_PARSE(app, argc, argv);
    namespace bench = lastflat::bench;
    const std::string text = *tables  ? bench::tables(bench::subjects(only), runs)
                             : *speed ? bench::speed(runs)
                                      : bench::scaling(largest);
    std::cout << text;
    const std::string name = *tables ? "tables" : *speed ? "speed" : "scaling";
    if (file.empty() || write_between(file, name, text)) return 0;
    std::cerr << "no place for " << name << " in " << file << "\n";
    return 2;
}
