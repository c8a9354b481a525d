#include "server/support/flat_memory.h"

#include <malloc.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

namespace lastflat::server {
namespace {

void start_again_without_thread_caches(char** argv) {
    constexpr const char* variable = "GLIBC_TUNABLES";
    if (std::getenv(variable) != nullptr) return;
    std::error_code failed;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", failed);
    if (failed || setenv(variable, "glibc.malloc.tcache_count=0", 1) != 0) return;
    execv(program.c_str(), argv);  // where it returns, the caches stay: larger by a few MiB
}

}  // namespace

void keep_memory_flat(char** argv) {
    start_again_without_thread_caches(argv);
    constexpr int arenas = 2, mapped_from = 128 << 10;
    mallopt(M_ARENA_MAX, arenas);
    mallopt(M_MMAP_THRESHOLD, mapped_from);
    mallopt(M_TRIM_THRESHOLD, mapped_from);
}

}  // namespace lastflat::server
