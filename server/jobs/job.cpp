#include "server/jobs/job.h"

#include "server/support/clock.h"
#include "server/support/crypto.h"

namespace lastflat::server {

std::string new_job_id() {
    constexpr char alphabet[] = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";
    const std::string random = random_bytes(16);
    std::string id(26, '0');
    auto time = static_cast<std::uint64_t>(now_ms());
    for (std::size_t i = 10; i-- > 0; time /= 32) id[i] = alphabet[time % 32];
    for (std::size_t i = 0; i < 16; ++i) {
        id[10 + i] = alphabet[static_cast<unsigned char>(random[i]) % 32];
    }
    return id;
}

}  // namespace lastflat::server
