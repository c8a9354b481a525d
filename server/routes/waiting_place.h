// A place to wait in: of the room that all have, and of the half of it that one key may have.
#pragma once

#include "server/routes/service.h"

namespace lastflat::server {

class WaitingPlace {
public:
    WaitingPlace(Service& service, const http::Request& request)
        : places_(service.places),
          key_(request.principal),
          has_share_(places_.enter(key_, (service.settings.streams + 1) / 2)),
          seat_(has_share_ ? request.waiting_room : nullptr) {}
    ~WaitingPlace() {
        if (has_share_) places_.leave(key_);
    }
    WaitingPlace(const WaitingPlace&) = delete;
    WaitingPlace& operator=(const WaitingPlace&) = delete;
    /// False: there is none; do not wait.
    [[nodiscard]] bool is_taken() const { return seat_.is_taken(); }

private:
    PlacesByKey& places_;
    const std::string key_;
    const bool has_share_;
    const http::Seat seat_;
};

}  // namespace lastflat::server
