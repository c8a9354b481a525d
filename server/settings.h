// What an operator may set.
#pragma once

#include <cstddef>
#include <string>

namespace lastflat::server {

struct Settings {
    std::string host = "127.0.0.1";
    int port = 8080;
    std::size_t workers = 0;        ///< 0: one for each core
    std::size_t queue = 256;        ///< jobs waiting
    std::size_t max_body_mb = 256;  ///< of one request
    std::size_t connections = 64;   ///< served at once
    int grace_seconds = 20;         ///< for running jobs when the service ends
};

}  // namespace lastflat::server
