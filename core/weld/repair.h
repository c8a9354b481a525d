// What was changed in a model so that it is a surface.
#pragma once

#include <string>
#include <vector>

#include "core/numerics/types.h"

namespace lastflat {

struct Repair {
    std::string code;
    std::string detail;                ///< what was done, for people
    std::size_t count;                 ///< how often
    Points3 positions{};               ///< where, mm; the first `most_listed`
    std::vector<double> lengths_mm{};  ///< at each position, where what was mended has a length

    static constexpr std::size_t most_listed = 10;
};

/// Collects the positions of one kind of repair.
class RepairNote {
public:
    void at(const Vec3& position) {
        if (++count_ <= Repair::most_listed) positions_.push_back(position);
    }
    [[nodiscard]] std::size_t count() const { return count_; }
    /// Appends the repair if there was any.
    void write(std::vector<Repair>& repairs, std::string code, const std::string& what) const {
        if (count_ > 0)
            repairs.push_back(
                {std::move(code), std::to_string(count_) + " " + what, count_, positions_});
    }

private:
    std::size_t count_ = 0;
    Points3 positions_;
};

}  // namespace lastflat
