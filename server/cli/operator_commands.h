// The commands of those who operate the service; they may run beside it.
#pragma once

#include <string>

#include "server/jobs/key_store.h"

namespace lastflat::server {

/// Prints the new key once.
[[nodiscard]] int add_key_command(const std::string& data, const NewKey& key);
[[nodiscard]] int revoke_key_command(const std::string& data, const std::string& id);
[[nodiscard]] int list_keys_command(const std::string& data);

/// The newest jobs, one a line; of one state if it is given.
[[nodiscard]] int jobs_command(const std::string& data, const std::string& state, int limit);

/// Checks every row and every blob; 0: all is well, 2: something is not, and it says what.
[[nodiscard]] int doctor_command(const std::string& data);

}  // namespace lastflat::server
