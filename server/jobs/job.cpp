#include "server/jobs/job.h"

#include <array>
#include <chrono>
#include <random>

namespace lastflat::server {

std::int64_t now_ms() {
    using namespace std::chrono;
    return duration_cast<milliseconds>(system_clock::now().time_since_epoch()).count();
}

std::string new_job_id() {
    constexpr char alphabet[] = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";
    std::string id(26, '0');
    auto time = static_cast<std::uint64_t>(now_ms());
    for (std::size_t i = 10; i-- > 0; time /= 32) id[i] = alphabet[time % 32];
    std::random_device random;  // the system's generator, not a seeded one
    for (std::size_t i = 10; i < id.size(); ++i) id[i] = alphabet[random() % 32];
    return id;
}

}  // namespace lastflat::server
