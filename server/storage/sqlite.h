// SQLite as the stores use it: one writer, several readers, statements prepared once.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "server/support/files.h"
#include "server/support/scope_exit.h"

namespace lastflat::server {

/// A prepared statement while it runs. Reset at its end, so that no reader keeps an old state of
/// the database open.
class Query {
public:
    explicit Query(SQLite::Statement& statement) : statement_(statement) {}
    ~Query() {
        statement_.tryReset();
        statement_.clearBindings();
    }
    Query(const Query&) = delete;
    Query& operator=(const Query&) = delete;

    /// The values of the question marks, in their order.
    template <class... Values>
    Query& bind(const Values&... values) {
        (bind_one(values), ...);
        return *this;
    }
    /// False: there is no further row.
    [[nodiscard]] bool next() { return statement_.executeStep(); }
    /// Returns how many rows were changed.
    int run() { return statement_.exec(); }

    [[nodiscard]] std::string text(int column) const {
        return statement_.getColumn(column).getString();
    }
    [[nodiscard]] std::int64_t number(int column) const {
        return statement_.getColumn(column).getInt64();
    }
    [[nodiscard]] std::optional<std::int64_t> maybe_number(int column) const {
        if (statement_.getColumn(column).isNull()) return std::nullopt;
        return number(column);
    }

private:
    void bind_one(const std::string& text) { statement_.bind(++bound_, text); }
    void bind_one(std::string_view text) { statement_.bind(++bound_, std::string(text)); }
    void bind_one(const char* text) { statement_.bind(++bound_, std::string(text)); }
    void bind_one(std::int64_t value) { statement_.bind(++bound_, value); }
    void bind_one(std::uint64_t value) {
        statement_.bind(++bound_, static_cast<std::int64_t>(value));
    }
    void bind_one(int value) { statement_.bind(++bound_, value); }
    template <class Value>
    void bind_one(const std::optional<Value>& value) {
        if (value)
            bind_one(*value);
        else
            statement_.bind(++bound_);
    }

    SQLite::Statement& statement_;
    int bound_ = 0;
};

class SqliteConnection {
public:
    SqliteConnection(const std::filesystem::path& file, bool read_only);
    /// Prepared at the first call with this text.
    [[nodiscard]] SQLite::Statement& prepared(const std::string& sql);
    [[nodiscard]] SQLite::Database& database() { return database_; }

private:
    SQLite::Database database_;
    std::unordered_map<std::string, std::unique_ptr<SQLite::Statement>> statements_;
};

/// Told how long a transaction took, in seconds; its waiting for others included.
using SqliteClock = std::function<void(bool writes, double seconds)>;

class SqliteDatabase {
public:
    /// Makes the file if it is missing and brings its schema up to date.
    /// Throws: StoreError, also if a newer version of the program made the file.
    explicit SqliteDatabase(const std::filesystem::path& file, SqliteClock clock = {});

    /// Throws: StoreError if a page of the file is damaged.
    void require_sound();
    /// Writes and reads. Throws: StoreError if either cannot be done.
    void check();

    /// Runs `work(connection)` in a transaction that is on the disk at the end, or did not happen.
    template <class Work>
    auto write(Work work) {
        return timed(true, [&] {
            const std::scoped_lock lock(writing_);
            require_file();
            SQLite::Transaction transaction(writer_->database(),
                                            SQLite::TransactionBehavior::IMMEDIATE);
            if constexpr (std::is_void_v<decltype(work(*writer_))>) {
                work(*writer_);
                transaction.commit();
            } else {
                auto result = work(*writer_);
                transaction.commit();
                return result;
            }
        });
    }
    /// Runs `work(connection)` on one state of the database.
    template <class Work>
    auto read(Work work) {
        return timed(false, [&] {
            require_file();
            auto connection = borrow();
            const ScopeExit at_end([&] { give_back(std::move(connection)); });
            SQLite::Transaction transaction(connection->database());
            return work(*connection);
        });
    }

    /// "ok", or what is wrong with the file.
    [[nodiscard]] std::string integrity();

private:
    template <class Work>
    auto timed(bool writes, Work work) {
        const double begun = seconds();
        const ScopeExit at_end([&] {
            if (clock_) clock_(writes, seconds() - begun);
        });
        try {
            return work();
        } catch (const SQLite::Exception& error) {
            throw StoreError(std::string("the database failed: ") + error.what());
        }
    }
    /// What is written to a file without a name is lost.
    void require_file() const;
    [[nodiscard]] static double seconds();
    [[nodiscard]] std::unique_ptr<SqliteConnection> borrow();
    void give_back(std::unique_ptr<SqliteConnection> connection);

    const std::filesystem::path file_;
    FileIdentity identity_;  ///< of the file that is open
    const SqliteClock clock_;
    std::mutex writing_;
    std::unique_ptr<SqliteConnection> writer_;
    std::mutex lending_;
    std::vector<std::unique_ptr<SqliteConnection>> readers_;
};

}  // namespace lastflat::server
