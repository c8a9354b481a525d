#include "server/storage/sqlite.h"

#include <algorithm>
#include <chrono>

#include "server/storage/sqlite_schema.h"

namespace lastflat::server {
namespace {

constexpr int busy_ms = 10'000;
constexpr std::size_t most_idle_readers = 8;

}  // namespace

SqliteConnection::SqliteConnection(const std::filesystem::path& file, bool read_only)
    : database_(file.string(),
                read_only ? SQLite::OPEN_READONLY : SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE,
                busy_ms) {
    // KiB. The system has the file in memory; caches of their own only fill up for hours.
    database_.exec(read_only ? "PRAGMA cache_size=-64" : "PRAGMA cache_size=-512");
    if (read_only) return;
    database_.exec("PRAGMA journal_mode=WAL");
    database_.exec("PRAGMA synchronous=FULL");
    database_.exec("PRAGMA journal_size_limit=67108864");
}

SQLite::Statement& SqliteConnection::prepared(const std::string& sql) {
    auto& statement = statements_[sql];
    if (!statement) statement = std::make_unique<SQLite::Statement>(database_, sql);
    return *statement;
}

SqliteDatabase::SqliteDatabase(const std::filesystem::path& file, SqliteClock clock)
    : file_(file), clock_(std::move(clock)) {
    try {
        writer_ = std::make_unique<SqliteConnection>(file, false);
        const int schema = writer_->database().execAndGet("PRAGMA user_version").getInt();
        // Damage must not be copied into tables that then look sound.
        if (schema > 0 && schema < newest_schema) require_sound();
        migrate(writer_->database());
        identity_ = identity_of(file);
    } catch (const SQLite::Exception& error) {
        throw StoreError("cannot use " + file.string() + ": " + error.what() +
                         "; if it is damaged, put it back from a backup");
    }
}

void SqliteDatabase::require_file() const {
    if (!identity_ || identity_of(file_) == identity_) return;  // nothing: it is being opened
    throw StoreError("the database " + file_.string() +
                     " was removed or replaced while it is in use; stop the service and put it "
                     "back from a backup");
}

void SqliteDatabase::require_sound() {
    std::string verdict = read([](SqliteConnection& connection) {
        return connection.database().execAndGet("PRAGMA quick_check(1)").getString();
    });
    std::replace(verdict.begin(), verdict.end(), '\n', ' ');
    if (verdict != "ok")
        throw StoreError("the database " + file_.string() + " is damaged (" + verdict +
                         "); put it back from a backup");
}

void SqliteDatabase::check() {
    write([](SqliteConnection& connection) {
        Query(connection.prepared("UPDATE secrets SET value = value")).run();
    });
    read([](SqliteConnection& connection) {
        Query query(connection.prepared("SELECT count(*) FROM secrets"));
        return query.next();
    });
}

double SqliteDatabase::seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

std::unique_ptr<SqliteConnection> SqliteDatabase::borrow() {
    {
        const std::scoped_lock lock(lending_);
        if (!readers_.empty()) {
            auto connection = std::move(readers_.back());
            readers_.pop_back();
            return connection;
        }
    }
    return std::make_unique<SqliteConnection>(file_, true);
}

void SqliteDatabase::give_back(std::unique_ptr<SqliteConnection> connection) {
    const std::scoped_lock lock(lending_);
    if (readers_.size() < most_idle_readers) readers_.push_back(std::move(connection));
}

std::string SqliteDatabase::integrity() {
    return read([](SqliteConnection& connection) -> std::string {
        std::string verdict =
            connection.database().execAndGet("PRAGMA integrity_check").getString();
        Query miscounted(connection.prepared(
            "SELECT owner FROM usage u WHERE bytes <> "
            "(SELECT coalesce(sum(bytes), 0) FROM kept WHERE owner = u.owner) LIMIT 1"));
        if (verdict == "ok" && miscounted.next())
            return "what the key '" + miscounted.text(0) + "' keeps is not what is noted";
        return verdict;
    });
}

}  // namespace lastflat::server
