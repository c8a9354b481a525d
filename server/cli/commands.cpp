#include "server/cli/commands.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iostream>
#include <thread>

#include "api/flatten_request.h"
#include "api/model_report.h"
#include "api/nearest_name.h"
#include "api/problem_of.h"
#include "api/refusal.h"
#include "api/result_table.h"
#include "api/sample_request.h"
#include "core/export/write_model.h"
#include "core/inspect.h"
#include "server/worker/map_points.h"
#include "server/worker/run_job.h"

namespace lastflat::server {
namespace {

namespace fs = std::filesystem;

constexpr int indent = 2;

/// The exit code of a command.
template <class Command>
int reported(Audience audience, const Command& command) {
    try {
        command();
        return 0;
    } catch (...) {
        return complain(api::problem_of(std::current_exception()), audience);
    }
}

std::vector<std::string> files_beside(const fs::path& path) {
    std::vector<std::string> names;
    const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error))
        names.push_back(entry->path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

std::string file_bytes(const fs::path& path, const std::string& what) {
    std::error_code error;
    std::ifstream file;
    if (!fs::is_directory(path, error)) file.open(path, std::ios::binary);
    if (!file.is_open()) {
        api::refuse("file_unreadable",
                    "cannot read " + what + path.string() +
                        (fs::exists(path, error)
                             ? ""
                             : ": there is no such file" +
                                   api::suggestion(path.filename().string(), files_beside(path))));
    }
    std::string bytes;
    if (const auto size = fs::file_size(path, error); !error) bytes.reserve(size);  // else a pipe
    std::array<char, 64u << 10> step;
    while (file.read(step.data(), step.size()), file.gcount() > 0)
        bytes.append(step.data(), static_cast<std::size_t>(file.gcount()));
    if (file.bad()) api::refuse("file_unreadable", "cannot read all of " + what + path.string());
    return bytes;
}

using Files = std::vector<std::pair<std::string, std::string_view>>;

/// Writes all files under other names, then renames them; on failure none is left.
void write_files(const fs::path& directory, const Files& files) {
    const auto beside = [&](const std::string& name) { return directory / ("." + name + ".part"); };
    std::vector<fs::path> made;
    try {
        fs::create_directories(directory);
        for (const auto& [name, bytes] : files) {
            made.push_back(beside(name));
            std::ofstream file(beside(name), std::ios::binary | std::ios::trunc);
            file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
            file.close();
            if (!file) throw std::runtime_error("cannot write " + (directory / name).string());
        }
        for (const auto& [name, bytes] : files) {
            fs::rename(beside(name), directory / name);
            made.push_back(directory / name);
        }
    } catch (const std::exception& error) {
        std::error_code ignored;
        for (const auto& path : made) fs::remove(path, ignored);
        api::refuse("file_unwritable", error.what());
    }
}

JobInput read_input(const fs::path& model, const std::optional<fs::path>& request) {
    JobInput input{file_bytes(model, "the model "), {}};
    const std::string constraints = request ? file_bytes(*request, "the request ") : std::string();
    input.options.request = api::flatten_request_from_json(constraints).asked;
    return input;
}

}  // namespace

int inspect_command(const fs::path& model, const std::optional<fs::path>& request,
                    Audience audience) {
    return reported(audience, [&] {
        const JobInput input = read_input(model, request);
        std::cout << api::to_json(inspect(input.model, input.options), indent) << std::endl;
    });
}

int map_command(const fs::path& flat_obj, const fs::path& points, Audience audience) {
    return reported(audience, [&] {
        const std::string pieces = file_bytes(flat_obj, ""), request = file_bytes(points, "");
        PatternMap map(read_flat_obj(pieces));
        std::cout << api::to_json(mapped(map, api::map_request_from_json(request)), indent)
                  << std::endl;
    });
}

int flatten_command(const fs::path& model, const std::optional<fs::path>& request,
                    const fs::path& directory, Audience audience) {
    return reported(audience, [&] {
        JobInput input = read_input(model, request);
        input.options.threads = std::max(1u, std::thread::hardware_concurrency());
        Progress progress;
        const FlattenResult result = flatten(input.model, input.options, progress);
        const JobOutput output = render(result);
        const Files files{{"result.json", output.json},
                          {"flat.obj", output.obj},
                          {"flat.glb", output.glb},
                          {"pattern.svg", output.svg}};
        write_files(directory, files);
        if (audience == Audience::programs) {
            std::cout << output.metrics << std::endl;
            return;
        }
        std::cout << api::to_table(result) << "written to " << directory.string() << ":";
        for (const auto& [name, bytes] : files) std::cout << " " << name;
        std::cout << std::endl;
    });
}

int sample_last_command(const SampleLastOptions& options, const fs::path& directory,
                        Audience audience) {
    return reported(audience, [&] {
        const SampleLast last = make_sample_last(options);
        const std::string obj = write_model_obj(last.mesh), glb = write_model_glb(last.mesh),
                          request = api::sample_request(last);
        write_files(directory,
                    {{"last.obj", obj}, {"last.glb", glb}, {"last.request.json", request}});
    });
}

}  // namespace lastflat::server
