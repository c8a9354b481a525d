// The program: `serve`, `flatten`, `sample-last`, and what operators need.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <iostream>
#include <map>

#include "api/job.h"
#include "api/nearest_name.h"
#include "server/cli/commands.h"
#include "server/cli/operator_commands.h"
#include "server/cli/serve.h"
#include "server/cli/usage_fault.h"
#include "server/http/client_address.h"
#include "server/support/clock.h"
#include "server/support/duration.h"
#include "server/support/flat_memory.h"
#include "server/support/version.h"

namespace {

using namespace lastflat;

/// "127.0.0.1:8080", "[::1]:0", "localhost:8080".
server::Address address_of(const std::string& option, const std::string& text) {
    server::Address address;
    const auto colon = text.rfind(':');
    std::size_t used = 0;
    const std::string port = colon == std::string::npos ? "" : text.substr(colon + 1);
    try {
        address.port = std::stoi(port, &used);
    } catch (const std::exception&) {
        used = 0;
    }
    if (colon == 0 || port.empty() || used != port.size() || address.port < 0 ||
        address.port > 65535) {
        throw CLI::ValidationError(option, "'" + text + "' is not HOST:PORT");
    }
    address.host = text.substr(0, colon);
    const std::string& host = address.host;
    if (host.size() > 2 && host.front() == '[' && host.back() == ']')
        address.host = host.substr(1, host.size() - 2);
    return address;
}

/// A word that stands for a value of an enum.
template <class Value>
CLI::Validator one_of(const std::map<std::string, Value>& values) {
    const auto read = [values](std::string& text) -> std::string {
        const auto found = values.find(text);
        std::vector<std::string> words;
        std::string list;
        for (const auto& [word, value] : values) {
            words.push_back(word);
            list += (list.empty() ? "" : ", ") + word;
        }
        if (found == values.end()) return "must be one of: " + list + api::suggestion(text, words);
        text = std::to_string(static_cast<int>(found->second));
        return {};
    };
    return CLI::Validator(read, "");
}

struct Arguments {
    server::Settings settings;
    std::string listen = "127.0.0.1:8080", admin, model, request, out;
    std::string key, state, scope = "all", expires;
    server::NewKey new_key;
    int limit = 50;
    SampleLastOptions sample;
};

/// An option of `serve` that is also a variable LASTFLAT_... and a line of the TOML file.
class ServeOptions {
public:
    explicit ServeOptions(CLI::App& app) : app_(app) {}

    template <class Value>
    CLI::Option* add(const std::string& name, Value& value, const std::string& help) {
        return named(name, app_.add_option("--" + name, value, help))->capture_default_str();
    }
    /// 90s, 2m, 1h, 7d.
    void add_duration(const std::string& name, std::int64_t& ms, const std::string& help) {
        const auto read = [&ms, name](const std::string& text) {
            const auto duration = server::duration_ms(text);
            if (!duration)
                throw CLI::ValidationError("--" + name,
                                           "'" + text + "' is not like 90s, 2m, 1h, 7d");
            ms = *duration;
        };
        named(name, app_.add_option_function<std::string>("--" + name, read, help))
            ->default_str(std::to_string(ms / 1000) + "s");
    }

private:
    static CLI::Option* named(const std::string& name, CLI::Option* option) {
        std::string variable = "LASTFLAT_";
        for (const char c : name)
            variable += c == '-' ? '_' : static_cast<char>(c >= 'a' ? c - 'a' + 'A' : c);
        return option->envname(variable);
    }
    CLI::App& app_;
};

CLI::App* add_serve(CLI::App& app, Arguments& a) {
    auto* serve = app.add_subcommand("serve", "Run the HTTP service");
    serve->set_config("--config", "", "Read settings from a TOML file");
    ServeOptions options(*serve);
    server::Settings& s = a.settings;
    options.add("listen", a.listen, "HOST:PORT; port 0 picks one");
    options.add("admin", a.admin, "HOST:PORT for /healthz, /readyz, /metrics; none: not served");
    options.add("data", s.data, "Folder of jobs, models and results; made if it is missing");
    options.add("workers", s.workers, "Jobs at once; 0: one for each core")
        ->check(CLI::Range(0, 256));
    options.add("queue", s.queue, "Jobs that may wait")->check(CLI::Range(1, 100000));
    options.add("queue-per-key", s.queue_per_key, "Jobs of one API key that may wait")
        ->check(CLI::Range(1, 100000));
    options.add("assets-per-key-mb", s.assets_per_key_mb, "Assets of one API key, MiB")
        ->check(CLI::Range(1, 1 << 24));
    options
        .add("storage-per-key-mb", s.storage_per_key_mb,
             "Models, results and assets of one API key together, MiB")
        ->check(CLI::Range(1, 1 << 24));
    options.add("min-free-mb", s.min_free_mb, "Room on the disk below which nothing is taken, MiB")
        ->check(CLI::Range(0, 1 << 24));
    options.add("rate", s.rate, "Requests of one API key in a minute; 0: any number");
    options.add("max-body-mb", s.max_body_mb, "Largest request, MiB")->check(CLI::Range(1, 4096));
    options.add("connections", s.connections, "Connections served at once")
        ->check(CLI::Range(1, 1024));
    options.add("streams", s.streams, "Event streams and long polls at once")
        ->check(CLI::Range(0, 1024));
    options.add("sessions", s.sessions, "Live sessions at once")->check(CLI::Range(0, 256));
    options.add("sessions-per-key", s.sessions_per_key, "Live sessions of one API key")
        ->check(CLI::Range(1, 256));
    options.add("session-rate", s.session_rate,
                "Requests of one API key to live sessions in a minute; 0: any number");
    options
        .add("session-memory-mb", s.session_memory_mb, "Memory of one live session, MiB; 0: any")
        ->check(CLI::Range(0, 1 << 20));
    options.add_duration("session-idle", s.session_idle_ms,
                         "After which a live session that nobody asks ends");
    options.add("job-memory-mb", s.job_memory_mb, "Memory of one job, MiB; 0: any")
        ->check(CLI::Range(0, 1 << 20));
    options.add_duration("job-time", s.job_time_ms, "Time of one job");
    options.add_duration("lease", s.lease_ms, "How long a worker may be silent");
    options.add_duration("keep-results", s.result_ms, "How long a result is kept");
    options.add_duration("keep-jobs", s.job_ms, "How long a finished job is kept");
    options.add_duration("grace", s.grace_ms, "What running jobs get when the service ends");
    const std::map<std::string, server::WebhookTargets> targets{
        {"off", server::WebhookTargets::none},
        {"public", server::WebhookTargets::anywhere_public},
        {"any", server::WebhookTargets::anywhere}};
    options
        .add("webhooks", s.webhooks, "Where webhooks may go: off, public (no private address), any")
        ->transform(one_of(targets))
        ->default_str("off");
    options.add("allow-origin", s.allowed_origins, "Web pages that may call (CORS), by origin");
    options
        .add("trusted-proxy", s.trusted_proxies,
             "Addresses of proxies whose X-Forwarded-For names the client")
        ->check([](const std::string& text) {
            return http::is_address(text) ? "" : "'" + text + "' is no IP address";
        });
    return serve;
}

std::map<const CLI::App*, std::function<int()>> add_operator_commands(CLI::App& app, Arguments& a) {
    const std::string& data = a.settings.data;
    const auto with_data = [&](CLI::App* command) {
        command->add_option("--data", a.settings.data, "Folder of the service's data")
            ->envname("LASTFLAT_DATA")
            ->capture_default_str();
        return command;
    };
    std::map<const CLI::App*, std::function<int()>> commands;
    auto* keys = app.add_subcommand("keys", "API keys of the service");
    keys->require_subcommand(1);
    auto* add = with_data(keys->add_subcommand("add", "Make a key and print it once"));
    add->add_option("NAME", a.new_key.name, "Whose it is")->required();
    std::vector<std::string> scopes;
    for (const auto& scope : server::key_scopes) scopes.emplace_back(scope.word);
    add->add_option("--scope", a.scope, "all; jobs: deletes nothing, no webhooks, no tokens; read")
        ->check(CLI::IsMember(scopes));
    add->add_option("--expires", a.expires, "After so long it is no longer good: 90d, 12h")
        ->check([](const std::string& text) {
            return server::duration_ms(text) ? std::string()
                                             : "'" + text + "' is not like 90d, 12h";
        });
    commands[add] = [&] {
        a.new_key.scope = api::value_of(server::key_scopes, a.scope).value();
        if (const auto time = server::duration_ms(a.expires))
            a.new_key.expires_ms = server::now_ms() + *time;
        return server::add_key_command(data, a.new_key);
    };
    auto* revoke = with_data(keys->add_subcommand("revoke", "Make a key useless"));
    revoke->add_option("ID", a.key, "Of the key, as `keys list` shows it")->required();
    commands[revoke] = [&] { return server::revoke_key_command(data, a.key); };
    commands[with_data(keys->add_subcommand("list", "All keys"))] = [&] {
        return server::list_keys_command(data);
    };
    auto* jobs = with_data(app.add_subcommand("jobs", "The newest jobs, one a line"));
    std::vector<std::string> states;
    for (const auto& state : api::job_states) states.emplace_back(state.word);
    jobs->add_option("--state", a.state, "Only of this state")->check(CLI::IsMember(states));
    jobs->add_option("--limit", a.limit, "How many")->check(CLI::Range(1, 100000));
    commands[jobs] = [&] { return server::jobs_command(data, a.state, a.limit); };
    commands[with_data(app.add_subcommand("doctor", "Check every row and every blob"))] = [&] {
        return server::doctor_command(data);
    };
    return commands;
}

/// Found anywhere among the arguments, so that it counts for those that cannot be read, too.
constexpr char json_flag[] = "--json";

void add_json(CLI::App& command) {
    command.add_flag(json_flag)->description("Say everything as JSON, errors as problem documents");
}

server::Audience audience_of(int argc, char** argv) {
    return std::find(argv, argv + argc, std::string_view(json_flag)) == argv + argc
               ? server::Audience::people
               : server::Audience::programs;
}

CLI::App* add_inspect(CLI::App& app, Arguments& a) {
    auto* inspect = app.add_subcommand("inspect", "Say what a model is and what is wrong with it");
    inspect->add_option("MODEL", a.model, "The last: OBJ, STL, PLY, glTF or GLB")->required();
    inspect->add_option("--request", a.request, "The constraint JSON; default: every default");
    add_json(*inspect);
    return inspect;
}

CLI::App* add_map(CLI::App& app, Arguments& a) {
    auto* map = app.add_subcommand("map", "Points of the last on its pattern, and back");
    map->add_option("FLAT_OBJ", a.model, "flat.obj of `flatten`")->required();
    map->add_option("POINTS", a.request,
                    "JSON: to_pattern and to_last, each with points and "
                    "polylines")
        ->required();
    add_json(*map);
    return map;
}

CLI::App* add_flatten(CLI::App& app, Arguments& a) {
    auto* flatten = app.add_subcommand("flatten", "Flatten one last without a server");
    flatten->add_option("MODEL", a.model, "The last: OBJ, STL, PLY, glTF or GLB")->required();
    flatten->add_option("--request", a.request, "The constraint JSON; default: every default");
    flatten->add_option("--out", a.out, "Folder for result.json, flat.obj, flat.glb, pattern.svg")
        ->required();
    add_json(*flatten);
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
        ->transform(one_of(toes));
    sample->add_option("--out", a.out, "Folder for last.obj, last.glb, last.request.json")
        ->required();
    add_json(*sample);
    return sample;
}

int run(int argc, char** argv) {
    Arguments a;
    CLI::App app(
        "lastflat: 3D shoe lasts to flat patterns whose named curves keep their length exactly");
    app.set_version_flag("--version", std::string("lastflat ") + server::build);
    app.require_subcommand(1);
    const auto* serve = add_serve(app, a);
    const auto* flatten = add_flatten(app, a);
    const auto* inspect = add_inspect(app, a);
    const auto* map = add_map(app, a);
    const auto* sample = add_sample_last(app, a);
    const auto operator_commands = add_operator_commands(app, a);
    const server::Audience audience = audience_of(argc, argv);
    try {
        app.parse(argc, argv);
        a.settings.listen = address_of("--listen", a.listen);
        if (!a.admin.empty()) a.settings.admin = address_of("--admin", a.admin);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        return server::complain({"arguments_invalid", server::usage_fault(app, error)}, audience);
    }
    for (const auto& [command, execute] : operator_commands) {
        if (command->parsed()) return execute();
    }
    const auto request =
        a.request.empty() ? std::nullopt : std::optional<std::filesystem::path>(a.request);
    if (flatten->parsed()) return server::flatten_command(a.model, request, a.out, audience);
    if (map->parsed()) return server::map_command(a.model, a.request, audience);
    if (inspect->parsed()) return server::inspect_command(a.model, request, audience);
    if (sample->parsed()) return server::sample_last_command(a.sample, a.out, audience);
    if (serve->parsed()) {
        server::keep_memory_flat(argv);
        server::serve(a.settings);
    }
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
