// The tables, and how an older file becomes a newer one.
#pragma once

#include <SQLiteCpp/Database.h>

namespace lastflat::server {

/// Runs the migrations that the file has not had, each as a whole.
/// Throws: SQLite::Exception; StoreError if the file is newer than the program.
void migrate(SQLite::Database& database);

}  // namespace lastflat::server
