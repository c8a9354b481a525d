// A worker that stays: a live session.
#pragma once

#include <string>

#include "server/protocol/work_messages.h"

namespace lastflat::server {

/// Opens a session on the model, says so by the answer to ask 0, then answers what is asked on
/// standard input (see `session_messages.h`) until that ends. A change whose sequence is not above
/// that of another that has come is answered `superseded`, at once; so is one that is being
/// computed when a newer comes. Ends the process.
[[noreturn]] void session_loop(const WorkOrder& order, std::string model);

/// The same of a pattern that is only mapped on. `flat_obj`: a result's.
[[noreturn]] void map_loop(const std::string& flat_obj);

}  // namespace lastflat::server
