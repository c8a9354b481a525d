// The program: `serve`, `flatten`, `sample-last`.
#include <CLI/CLI.hpp>
#include <iostream>

#include "server/commands.h"
#include "server/serve.h"
#include "server/version.h"

namespace {

using namespace lastflat;

/// "127.0.0.1:8080", "[::1]:0", "localhost:8080".
void read_listen(const std::string& listen, server::Settings& settings) {
    const auto colon = listen.rfind(':');
    std::size_t used = 0;
    const std::string port = colon == std::string::npos ? "" : listen.substr(colon + 1);
    try {
        settings.port = std::stoi(port, &used);
    } catch (const std::exception&) {
        used = 0;
    }
    if (colon == 0 || port.empty() || used != port.size() || settings.port < 0 ||
        settings.port > 65535) {
        throw CLI::ValidationError("--listen", "'" + listen + "' is not HOST:PORT");
    }
    settings.host = listen.substr(0, colon);
    if (settings.host.size() > 2 && settings.host.front() == '[' && settings.host.back() == ']') {
        settings.host = settings.host.substr(1, settings.host.size() - 2);
    }
}

struct Arguments {
    server::Settings settings;
    std::string listen = "127.0.0.1:8080", model, request, out, data;
    SampleLastOptions sample;
};

CLI::App* add_serve(CLI::App& app, Arguments& a) {
    auto* serve = app.add_subcommand("serve", "Run the HTTP service");
    serve->set_config("--config", "", "Read settings from a TOML file");
    serve->add_option("--listen", a.listen, "HOST:PORT; port 0 picks one")
        ->envname("LASTFLAT_LISTEN")
        ->capture_default_str();
    serve
        ->add_option(
            "--data", a.data,
            "Folder for the service's data; this version keeps jobs in memory and leaves it alone")
        ->envname("LASTFLAT_DATA");
    serve->add_option("--workers", a.settings.workers, "Jobs at once; 0: one for each core")
        ->envname("LASTFLAT_WORKERS")
        ->check(CLI::Range(0, 256))
        ->capture_default_str();
    serve->add_option("--queue", a.settings.queue, "Jobs that may wait")
        ->envname("LASTFLAT_QUEUE")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    serve->add_option("--max-body-mb", a.settings.max_body_mb, "Largest request, MiB")
        ->envname("LASTFLAT_MAX_BODY_MB")
        ->check(CLI::Range(1, 4096))
        ->capture_default_str();
    serve->add_option("--connections", a.settings.connections, "Connections served at once")
        ->envname("LASTFLAT_CONNECTIONS")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    serve
        ->add_option("--grace", a.settings.grace_seconds,
                     "Seconds that running jobs get at the end")
        ->envname("LASTFLAT_GRACE")
        ->check(CLI::Range(0, 3600))
        ->capture_default_str();
    return serve;
}

CLI::App* add_flatten(CLI::App& app, Arguments& a) {
    auto* flatten = app.add_subcommand("flatten", "Flatten one last without a server");
    flatten->add_option("MODEL", a.model, "The last: OBJ, glTF or GLB")->required();
    flatten->add_option("--request", a.request, "The constraint JSON; default: every default");
    flatten->add_option("--out", a.out, "Folder for result.json, flat.obj, flat.glb, pattern.svg")
        ->required();
    return flatten;
}

CLI::App* add_sample_last(CLI::App& app, Arguments& a) {
    auto* sample = app.add_subcommand("sample-last", "Write a last to try things on");
    const std::map<std::string, ToeShape> toes{{"round", ToeShape::round},
                                               {"almond", ToeShape::almond},
                                               {"pointed", ToeShape::pointed},
                                               {"square", ToeShape::square}};
    sample->add_option("--size", a.sample.size_eu, "EU size")->capture_default_str();
    sample->add_option("--heel-height", a.sample.heel_height_mm, "mm")->capture_default_str();
    sample->add_option("--toe-spring", a.sample.toe_spring_mm, "mm")->capture_default_str();
    sample->add_option("--extra-girth", a.sample.extra_girth_mm, "mm")->capture_default_str();
    sample->add_option("--toe", a.sample.toe, "round, almond, pointed or square")
        ->transform(CLI::CheckedTransformer(toes));
    sample->add_option("--out", a.out, "Folder for last.obj, last.glb, last.request.json")
        ->required();
    return sample;
}

int run(int argc, char** argv) {
    Arguments a;
    CLI::App app(
        "lastflat: 3D shoe lasts to flat patterns whose named curves keep their length exactly");
    app.set_version_flag("--version", std::string("lastflat ") + server::version);
    app.require_subcommand(1);
    const auto* serve = add_serve(app, a);
    const auto* flatten = add_flatten(app, a);
    const auto* sample = add_sample_last(app, a);
    try {
        app.parse(argc, argv);
        if (serve->parsed()) read_listen(a.listen, a.settings);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    if (flatten->parsed()) {
        return server::flatten_command(
            a.model,
            a.request.empty() ? std::nullopt : std::optional<std::filesystem::path>(a.request),
            a.out);
    }
    if (sample->parsed()) return server::sample_last_command(a.sample, a.out);
    server::serve(a.settings);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const std::exception& error) {
        std::cerr << "lastflat: " << error.what() << std::endl;
        return 1;
    }
}
