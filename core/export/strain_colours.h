// The strain of the leather as colour: areas between levels, the scale, the worst place.
#pragma once

#include "core/export/svg_page.h"
#include "core/result.h"

namespace lastflat {

/// One scale for all pieces of a drawing. It runs to the strain that 99 % of their surface does not
/// exceed; beyond that colours are full. White is unstrained, red stretched or sheared, blue
/// gathered. Where nothing is shaded (`plain`) all is empty.
class StrainColours {
public:
    StrainColours(const std::vector<FlatRegion>& regions, Shading shading);

    /// The places of piece `r`, which lies as `positions` says, by the mean strain at its vertices.
    [[nodiscard]] std::string areas(const FlatRegion& flat, std::size_t r, const Points2& positions,
                                    const Page& page) const;
    /// The triangle that is the worst, with its strain.
    [[nodiscard]] std::string worst_mark(const FlatRegion& flat, std::size_t r,
                                         const Points2& positions, const Page& page) const;
    /// With its upper edge at `top`, in mm of the drawing.
    [[nodiscard]] std::string key(const Page& page, double top) const;
    /// What is under the key.
    [[nodiscard]] const char* caption() const;

private:
    [[nodiscard]] std::string strain_text(double strain) const;
    [[nodiscard]] double level(int shade) const;

    Shading shading_;
    std::vector<std::vector<double>> strains_;  ///< of the regions' triangles
    double range_ = 0.0;                        ///< where colours are full
};

}  // namespace lastflat
