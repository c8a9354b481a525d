#include "server/storage/data_directory.h"

#include <fcntl.h>
#include <sys/file.h>

namespace lastflat::server {

namespace fs = std::filesystem;

namespace {

constexpr char what_to_do[] =
    "put it back from a backup, or name an empty folder with --data to begin anew";

fs::path mark_of(const fs::path& folder) {
    return folder / "database";
}

bool has_blobs(const fs::path& folder) {
    std::error_code none;
    for (const auto& group : fs::directory_iterator(folder / "blobs", none)) {
        if (fs::directory_iterator(group, none) != fs::directory_iterator()) return true;
    }
    return false;
}

}  // namespace

fs::path sound_database(const fs::path& folder) {
    const fs::path file = folder / "jobs.sqlite";
    std::error_code none;
    const auto bytes = fs::file_size(file, none);
    const bool is_lost = none || bytes == 0;
    if (is_lost && (fs::exists(mark_of(folder), none) || has_blobs(folder))) {
        throw StoreError("the database " + file.string() +
                         " is missing or empty, though one was made here; " + what_to_do);
    }
    return file;
}

void mark_database(const fs::path& folder, const std::string& id) {
    const fs::path mark = mark_of(folder);
    std::error_code none;
    if (!fs::exists(mark, none)) return write_durably(mark, id);
    const File file(mark, O_RDONLY);
    if (file.read(0, file.size()) != id) {
        throw StoreError("the database in " + folder.string() +
                         " is not the one that was made here; " + what_to_do);
    }
}

DataDirectory::DataDirectory(const fs::path& folder) : folder_(fs::absolute(folder)) {
    std::error_code error;
    const bool made = fs::create_directories(folder_, error);
    if (error) throw StoreError("cannot make " + folder_.string() + ": " + error.message());
    if (made) {
        fs::permissions(folder_, fs::perms::owner_all, error);
        sync_folder(folder_.parent_path());
    }
    lock_ = std::make_unique<File>(folder_ / "lock", O_RDWR | O_CREAT);
    if (::flock(lock_->fd(), LOCK_EX | LOCK_NB) != 0) {
        throw StoreError("another process serves from " + folder_.string() +
                         "; end it, or name another folder with --data");
    }
    fs::remove_all(work(), error);
    fs::create_directory(work(), error);
    if (error) throw StoreError("cannot make " + work().string() + ": " + error.message());
}

}  // namespace lastflat::server
