// The tables, and how an older file becomes a newer one.
#pragma once

#include <SQLiteCpp/Database.h>

namespace lastflat::server {

/// What a file has that this program made.
inline constexpr int newest_schema = 8;

/// Runs the migrations up to `version` that the file has not had, each as a whole.
/// Throws: SQLite::Exception; StoreError if the file is newer than the program.
void migrate(SQLite::Database& database, int version = newest_schema);

}  // namespace lastflat::server
