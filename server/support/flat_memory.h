// How the service's allocator is set.
#pragma once

namespace lastflat::server {

/// Bodies and results come and go by the megabyte, on many threads. Few arenas, no caches of
/// threads, and large blocks that are mapped and unmapped keep the process as small after a year as
/// after a minute. The caches can only be set from the environment (GLIBC_TUNABLES, mallopt(3)), so
/// the program starts itself once more, under the same process id; whoever sets that variable has
/// the last word. Before any thread.
void keep_memory_flat(char** argv);

}  // namespace lastflat::server
