#include "server/cli/commands.h"

#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <thread>

#include "api/flatten_request.h"
#include "core/export/write_model.h"
#include "server/worker/inspect_job.h"
#include "server/worker/map_job.h"
#include "server/worker/problem_map.h"
#include "server/worker/run_job.h"

namespace lastflat::server {
namespace {

namespace fs = std::filesystem;

int report(const api::Problem& problem) {
    std::cerr << api::to_json(problem) << std::endl;
    return is_bad_input(problem) ? 2 : 1;
}

api::Problem file_problem(int status, const std::string& detail) {
    return {status,       status < 500 ? "file_unreadable" : "file_unwritable",
            "",           detail,
            std::nullopt, std::nullopt};
}

std::optional<std::string> file_bytes(const fs::path& path) {
    std::error_code error;
    if (fs::is_directory(path, error)) return std::nullopt;
    std::ifstream file(path, std::ios::binary);
    if (!file) return std::nullopt;
    std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    if (file.bad()) return std::nullopt;
    return bytes;
}

using Files = std::vector<std::pair<std::string, std::string_view>>;

/// Writes all files under other names, then renames them; on failure none is left.
void write_files(const fs::path& directory, const Files& files) {
    fs::create_directories(directory);
    const auto beside = [&](const std::string& name) { return directory / ("." + name + ".part"); };
    std::vector<fs::path> made;
    try {
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
    } catch (...) {
        std::error_code ignored;
        for (const auto& path : made) fs::remove(path, ignored);
        throw;
    }
}

int write_or_report(const fs::path& directory, const Files& files) {
    try {
        write_files(directory, files);
    } catch (const std::exception& error) {
        return report(file_problem(500, error.what()));
    }
    return 0;
}

std::string sample_request(const SampleLast& last) {
    nlohmann::ordered_json curves;
    for (const auto& [name, vertices] : last.curves) curves[name] = {{"vertices", vertices}};
    const nlohmann::ordered_json request{
        {"surface", {{"groups", {"upper"}}}},
        {"curves", curves},
        {"cuts", {"centre_front", "heel"}},
        {"regions",
         {{"lateral", {{"contains", {{"vertex", last.lateral_vertex}}}}},
          {"medial", {{"contains", {{"vertex", last.medial_vertex}}}}}}},
        {"locks", {{{"curve", "centre_front"}}, {{"curve", "heel"}}}},
        {"method", {{"name", "isometric"}}}};
    return request.dump() + "\n";
}

/// The files of a job, or why they cannot be used.
std::optional<api::Problem> read_input(const fs::path& model,
                                       const std::optional<fs::path>& request,
                                       std::optional<JobInput>& input) {
    auto bytes = file_bytes(model);
    if (!bytes) return file_problem(404, "cannot read the model " + model.string());
    std::optional<std::string> constraints = request ? file_bytes(*request) : std::string();
    if (!constraints) return file_problem(404, "cannot read the request " + request->string());
    try {
        FlattenOptions options;
        options.request = api::flatten_request_from_json(*constraints).asked;
        input = JobInput{std::move(*bytes), std::move(options)};
    } catch (const api::InvalidRequest& error) {
        return problem_of(error);
    } catch (const Error& error) {
        return problem_of(error);
    }
    return std::nullopt;
}

/// A report on standard output, or a problem on standard error.
int print(const nlohmann::ordered_json& found) {
    if (const auto problem = found.find("problem"); problem != found.end()) {
        std::cerr << problem->dump() << std::endl;
        return problem->at("status").get<int>() < 500 ? 2 : 1;
    }
    std::cout << found.at("report").dump(2) << std::endl;
    return 0;
}

}  // namespace

int inspect_command(const fs::path& model, const std::optional<fs::path>& request) {
    std::optional<JobInput> input;
    if (const auto problem = read_input(model, request, input)) return report(*problem);
    return print(inspect_job(*input));
}

int map_command(const fs::path& flat_obj, const fs::path& points) {
    const auto pieces = file_bytes(flat_obj), request = file_bytes(points);
    for (const auto& [bytes, path] :
         {std::pair(&pieces, &flat_obj), std::pair(&request, &points)}) {
        if (!*bytes) return report(file_problem(404, "cannot read " + path->string()));
    }
    return print(map_job(*pieces, *request));
}

int flatten_command(const fs::path& model, const std::optional<fs::path>& request,
                    const fs::path& directory) {
    std::optional<JobInput> input;
    if (const auto problem = read_input(model, request, input)) return report(*problem);
    input->options.threads = std::max(1u, std::thread::hardware_concurrency());
    Progress progress;
    const RunOutcome outcome = run_job(*input, Compression::none, progress);
    if (!outcome.output) return report(outcome.error.value());
    return write_or_report(directory, {{"result.json", outcome.output->json.bytes},
                                       {"flat.obj", outcome.output->obj.bytes},
                                       {"flat.glb", outcome.output->glb.bytes},
                                       {"pattern.svg", outcome.output->svg.bytes}});
}

int sample_last_command(const SampleLastOptions& options, const fs::path& directory) {
    SampleLast last;
    try {
        last = make_sample_last(options);
    } catch (const Error& error) {
        return report(problem_of(error));
    }
    const std::string obj = write_model_obj(last.mesh), glb = write_model_glb(last.mesh),
                      request = sample_request(last);
    return write_or_report(directory,
                           {{"last.obj", obj}, {"last.glb", glb}, {"last.request.json", request}});
}

}  // namespace lastflat::server
