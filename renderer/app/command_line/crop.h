// Part of a film, as --crop names it: corners in pixels or in percent.
#pragma once

#include <array>
#include <string>

#include "field/base/result.h"
#include "renderer/output/picture.h"

namespace marrow {

struct Crop {
  struct Coordinate {
    double value = 0;
    bool percent = false;
  };
  std::array<Coordinate, 4> corners;  ///< x0, y0, x1, y1; y counts downward
};

/// "x0,y0,x1,y1", each a whole number of pixels or, with %, a share of the film's size.
Result<Crop> parse_crop(const std::string&);

/// The window of a film of this size, percentages rounded to the nearest pixel edge and the whole clipped to the film.
/// Error: nothing of the film is left.
Result<PixelWindow> resolve(const Crop&, int width, int height);

}  // namespace marrow
