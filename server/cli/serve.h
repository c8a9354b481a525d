// The service, from start to end.
#pragma once

#include "server/cli/settings.h"

namespace lastflat::server {

/// Serves until SIGTERM or SIGINT; then takes nothing new, gives running jobs their grace, cancels
/// what is left and returns. Prints "listening on http://HOST:PORT" when it is ready.
/// Must be called before any other thread is started (it blocks the signals for all).
/// Throws: std::runtime_error if the address cannot be bound.
void serve(const Settings& settings);

}  // namespace lastflat::server
