// What a worker does: a process of its own for one task, so that whatever a model does to it
// happens to that task alone.
#pragma once

namespace lastflat::server {

/// Reads one `WorkOrder` from standard input, limits itself as that says, does its task and says
/// one message a line on standard output (see `work_messages.h`). Ends the process.
[[noreturn]] void work_command();

}  // namespace lastflat::server
