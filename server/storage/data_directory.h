// The folder that everything lasting is in, held by one process at a time.
//
//   jobs.sqlite    rows: jobs, keys, assets (SQLite, WAL)
//   database       which database was made here: a lost one is not taken for a new one
//   blobs/         models and results by digest
//   work/          of running jobs; emptied at every start
//   lock           held while a process serves
#pragma once

#include <filesystem>
#include <memory>

#include "server/support/files.h"

namespace lastflat::server {

/// The folder's database, which is there or may be made.
/// Throws: StoreError if one was made here and is lost: a new one would open the service to
/// anybody, and have every blob removed.
[[nodiscard]] std::filesystem::path sound_database(const std::filesystem::path& folder);

/// Notes that the database with this id is the folder's. Throws: StoreError if another one is.
void mark_database(const std::filesystem::path& folder, const std::string& id);

class DataDirectory {
public:
    /// Makes the folder if it is missing, locks it and empties `work`.
    /// Throws: StoreError, also if another process holds it.
    explicit DataDirectory(const std::filesystem::path& folder);

    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
    [[nodiscard]] std::filesystem::path blobs() const { return folder_ / "blobs"; }
    [[nodiscard]] std::filesystem::path work() const { return folder_ / "work"; }

private:
    const std::filesystem::path folder_;
    std::unique_ptr<File> lock_;
};

}  // namespace lastflat::server
