// The folder that everything lasting is in, held by one process at a time.
//
//   jobs.sqlite    rows: jobs, keys, assets (SQLite, WAL)
//   blobs/         models and results by digest
//   work/          of running jobs; emptied at every start
//   lock           held while a process serves
#pragma once

#include <filesystem>
#include <memory>

#include "server/support/files.h"

namespace lastflat::server {

class DataDirectory {
public:
    /// Makes the folder if it is missing, locks it and empties `work`.
    /// Throws: StoreError, also if another process holds it.
    explicit DataDirectory(const std::filesystem::path& folder);

    [[nodiscard]] std::filesystem::path database() const { return folder_ / "jobs.sqlite"; }
    [[nodiscard]] std::filesystem::path blobs() const { return folder_ / "blobs"; }
    [[nodiscard]] std::filesystem::path work() const { return folder_ / "work"; }

private:
    const std::filesystem::path folder_;
    std::unique_ptr<File> lock_;
};

}  // namespace lastflat::server
