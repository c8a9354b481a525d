#include "server/storage/data_directory.h"

#include <fcntl.h>
#include <sys/file.h>

namespace lastflat::server {

namespace fs = std::filesystem;

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
