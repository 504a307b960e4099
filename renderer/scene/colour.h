// Colours as scenes write them: linear numbers, sRGB codes and temperatures.
#pragma once

#include <optional>
#include <string_view>

#include "materials/rgb.h"
#include "renderer/scene/form.h"
#include "renderer/scene/table.h"

namespace marrow {

/// "#c89664" (or "#c96"), each channel through the sRGB curve of IEC 61966-2-1; nothing for other texts.
std::optional<Rgb> parse_srgb(std::string_view);

/// Linear Rec.709 colour of luminance 1 with the chromaticity of a black body; 1667 K to 25000 K, where the fit of
/// Kim et al. (US patent 7024034, 2002) is within 0.001 of the Planckian locus. Below about 1900 K the colour lies
/// outside Rec.709: blue is then 0 and the luminance 1 all the same.
Rgb black_body_colour(double kelvin);

/// [r, g, b], a grey number, "#rrggbb" or {kelvin:, luminance:}; each channel in `range`.
Form<Rgb> colour(Range);
/// A colour of reflectance, 0 to 1.
Form<Rgb> albedo();
/// A colour of light, not negative.
Form<Rgb> radiance();

const TableInfo& kelvin_table_info();

}  // namespace marrow
