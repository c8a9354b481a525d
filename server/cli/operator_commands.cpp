#include "server/cli/operator_commands.h"

#include <sys/stat.h>

#include <filesystem>
#include <iostream>

#include "api/timestamp.h"
#include "server/storage/blob_folder.h"
#include "server/storage/data_directory.h"
#include "server/storage/sqlite_accounts.h"
#include "server/storage/sqlite_store.h"
#include "server/support/clock.h"

namespace lastflat::server {
namespace {

namespace fs = std::filesystem;

/// The database; a command that looks must not make what it is to look at.
fs::path existing_database(const std::string& data) {
    fs::path database = sound_database(data);
    if (!fs::exists(database))
        throw StoreError(data + " holds no data of the service; name its folder with --data");
    return database;
}

/// Visits all jobs, page by page.
template <class Visit>
void for_each_job(SqliteStore& store, Visit visit) {
    JobFilter filter;
    filter.limit = 500;
    for (;;) {
        const JobList list = store.list("", filter);
        for (const JobRecord& job : list.jobs) visit(job);
        if (!list.next) return;
        filter.before = list.next;
    }
}

class Doctor {
public:
    explicit Doctor(const std::string& data)
        : database_(existing_database(data)),
          store_(database_, Retention{}),
          blobs_(BlobFolder::Looking{}, fs::path(data) / "blobs") {}

    std::size_t examine() {
        check_database();
        for_each_job(store_, [&](const JobRecord& job) { check(job); });
        std::size_t orphans = 0;
        for (const std::string& digest : blobs_.all()) {
            if (!store_.needs_blob(digest)) ++orphans;
        }
        std::cout << jobs_ << " jobs, " << blobs_.all().size() << " blobs (" << orphans
                  << " that nothing needs; the next start removes them), " << faults_
                  << " faults\n";
        return faults_;
    }

private:
    void complain(const std::string& what) {
        ++faults_;
        std::cout << "FAULT " << what << "\n";
    }

    void check_database() {
        const std::string verdict = database_.integrity();
        if (verdict != "ok") complain("database: " + verdict);
    }

    void check_blob(const JobRecord& job, const char* what, const std::string& digest) {
        try {
            (void)blobs_.read(digest);
        } catch (const std::exception& error) {
            // The service may have gone on meanwhile: then nothing needs the blob any more.
            if (store_.needs_blob(digest))
                complain("job " + job.id + ", its " + what + ": " + error.what());
        }
    }

    void check(const JobRecord& job) {
        ++jobs_;
        if (!is_final(job.state)) check_blob(job, "model", job.model);
        if (!job.result.empty()) check_blob(job, "result", job.result);
        if (is_final(job.state) != job.finished_ms.has_value())
            complain("job " + job.id + ": its state and its end contradict each other");
        if ((job.state == JobState::failed) != job.error.has_value())
            complain("job " + job.id + ": its state and its error contradict each other");
        if (job.attempt > most_attempts) complain("job " + job.id + ": too many attempts");
        const auto changes = store_.history(job.number, 0);
        if (changes.empty() || changes.back().state != job.state)
            complain("job " + job.id + ": its history does not lead to its state");
    }

    SqliteDatabase database_;
    SqliteStore store_;
    const BlobFolder blobs_;
    std::size_t jobs_ = 0, faults_ = 0;
};

/// For people.
std::string state_of(const ApiKey& key) {
    if (key.revoked_ms) return "revoked";
    if (!key.expires_ms) return "good";
    return (*key.expires_ms > now_ms() ? "good until " : "expired ") +
           api::rfc3339(*key.expires_ms);
}

}  // namespace

int add_key_command(const std::string& data, const NewKey& key) {
    umask(S_IRWXG | S_IRWXO);
    fs::create_directories(data);
    SqliteDatabase database(sound_database(data));
    SqliteKeys keys(database);
    mark_database(data, keys.secret("database"));
    std::cout << keys.add(key) << std::endl;
    std::cerr << "Keep it: it is stored as a hash and cannot be shown again.\n";
    return 0;
}

int revoke_key_command(const std::string& data, const std::string& id) {
    SqliteDatabase database(existing_database(data));
    if (SqliteKeys(database).revoke(id)) return 0;
    std::cerr << "lastflat: there is no key " << id << " that is not revoked yet\n";
    return 2;
}

int list_keys_command(const std::string& data) {
    SqliteDatabase database(existing_database(data));
    for (const ApiKey& key : SqliteKeys(database).list()) {
        std::cout << key.id << "  " << api::rfc3339(key.created_ms) << "  " << state_of(key) << "  "
                  << api::word_of(key_scopes, key.scope) << "  " << key.name << "\n";
    }
    return 0;
}

int jobs_command(const std::string& data, const std::string& state, int limit) {
    SqliteDatabase database(existing_database(data));
    SqliteStore store(database, Retention{});
    JobFilter filter;
    if (!state.empty()) filter.state = api::value_of(api::job_states, state);
    filter.limit = static_cast<std::size_t>(limit);
    for (const JobRecord& job : store.list("", filter).jobs) {
        std::cout << job.id << "  " << api::rfc3339(job.created_ms) << "  " << name(job.state)
                  << "  attempt " << job.attempt << "  " << job.tag << "\n";
    }
    return 0;
}

int doctor_command(const std::string& data) {
    return Doctor(data).examine() == 0 ? 0 : 2;
}

}  // namespace lastflat::server
