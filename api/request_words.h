// The words of a request.
#pragma once

#include "api/words.h"
#include "core/request.h"

namespace lastflat::api {

/// A unit of the model, in mm.
inline constexpr Word<double> unit_words[]{{"mm", 1.0}, {"cm", 10.0}, {"m", 1000.0}, {"in", 25.4}};

inline constexpr Word<MethodName> method_words[]{{"tutte", MethodName::tutte},
                                                 {"chord_length", MethodName::chord_length},
                                                 {"shape_preserving", MethodName::shape_preserving},
                                                 {"harmonic", MethodName::harmonic},
                                                 {"wachspress", MethodName::wachspress},
                                                 {"mean_value", MethodName::mean_value},
                                                 {"virtual_border", MethodName::virtual_border},
                                                 {"geodesic_fan", MethodName::geodesic_fan},
                                                 {"mips", MethodName::mips},
                                                 {"green_lagrange", MethodName::green_lagrange},
                                                 {"isometric", MethodName::isometric}};

inline constexpr Word<BorderShape> border_words[]{{"square", BorderShape::square},
                                                  {"circle", BorderShape::circle},
                                                  {"hull", BorderShape::hull},
                                                  {"floating", BorderShape::floating}};

inline constexpr Word<AngleRule> angle_words[]{
    {"curvature", AngleRule::curvature}, {"averaged_conformal", AngleRule::averaged_conformal}};

inline constexpr Word<Coincident> coincident_words[]{{"join", Coincident::join},
                                                     {"keep", Coincident::keep}};

inline constexpr Word<HoleRule> hole_words[]{
    {"auto", HoleRule::automatic}, {"keep", HoleRule::keep}, {"open", HoleRule::open}};

inline constexpr Word<FeatureRule> feature_words[]{
    {"auto", FeatureRule::automatic}, {"fill", FeatureRule::fill}, {"keep", FeatureRule::keep}};

inline constexpr Word<Keep> keep_words[]{{"edges", Keep::edges}, {"total", Keep::total}};

/// What a result has only if it is asked for.
inline constexpr Word<bool> include_words[]{{"fan", true}};

/// What the drawing shows: the fan (no value), or a quantity by colour.
inline constexpr Word<std::optional<Shading>> draw_words[]{
    {"fan", std::nullopt},       {"area", Shading::area},   {"stretch", Shading::stretch},
    {"gather", Shading::gather}, {"shear", Shading::shear}, {"plain", Shading::plain}};

inline constexpr Word<OnConflict> conflict_words[]{{"fail", OnConflict::fail},
                                                   {"relax", OnConflict::relax}};

}  // namespace lastflat::api
