#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "api/flatten_request.h"
#include "api/object_reader.h"
#include "core/cut/cut.h"
#include "core/load/load_model.h"
#include "core/weld/weld.h"
#include "tests/bench/bench.h"
#include "tests/helpers/face.h"
#include "tests/helpers/sample.h"

namespace lastflat::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t largest_table = 40'000;  // triangles; CGAL's rows take minutes beyond

std::string bytes_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void add_regions(const std::string& name, std::string_view model, const Request& request,
                 std::vector<Subject>& subjects) {
    SurfaceMesh surface = weld(load_model(model), request.weld);
    const auto regions = cut_into_regions(
        surface, insert_curves(surface, locate_curves(surface, request.curves)).curves,
        request.cut);
    for (const Region& region : regions) {
        if (region.triangles.size() > largest_table) {
            std::cerr << "skipped: " << name << " has more than " << largest_table
                      << " triangles\n";
            continue;
        }
        subjects.push_back(
            {regions.size() > 1 ? name + ", " + region.name : name, region, request.constraints});
    }
}

void add_folder(const char* variable, std::vector<Subject>& subjects) {
    const char* folder = std::getenv(variable);
    if (folder == nullptr) return;
    std::vector<fs::path> models;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const auto ending = entry.path().extension();
        if (entry.is_regular_file() && ending != ".json" && ending != ".md")
            models.push_back(entry.path());
    }
    std::sort(models.begin(), models.end());
    for (const fs::path& model : models) {
        fs::path request = model;
        request.replace_extension(".request.json");
        try {
            const std::string text = fs::exists(request) ? bytes_of(request) : "";
            add_regions(model.stem().string(), bytes_of(model),
                        api::flatten_request_from_json(text).asked, subjects);
        } catch (const std::runtime_error& error) {
            std::cerr << "skipped: " << model.filename().string() << ": " << error.what() << "\n";
        }
    }
}

}  // namespace

std::vector<Subject> subjects(const std::string& only) {
    std::vector<Subject> all;
    const SampleLast last = make_sample_last();
    add_regions("sample last", write_model_obj(last.mesh), test::sample_options(last).request, all);
    all.push_back({"face", test::face(), {}});
    add_folder("LASTFLAT_LASTS", all);
    add_folder("LASTFLAT_MESHES", all);
    std::erase_if(all, [&](const Subject& subject) {
        return subject.name.compare(0, only.size(), only) != 0;
    });
    return all;
}

}  // namespace lastflat::bench
