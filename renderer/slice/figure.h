// A picture of numbers with axes, a colour bar and a scale bar around it.
#pragma once

#include <string>
#include <utility>

#include "renderer/output/colormap.h"
#include "renderer/output/rgb_image.h"
#include "renderer/slice/slice.h"

namespace marrow {

/// The ticks of a colour bar that is long enough, and so the contours of the picture.
inline constexpr int most_bar_ticks = 11;

/// What the letters say. Texts are UTF-8.
struct FigureLabels {
  SliceWindow window;  ///< what the picture spans, in scene units
  std::string title, u_axis, v_axis;
  std::string units;  ///< of lengths; may be empty
  std::pair<double, double> range;
  double iso = 1;
  bool beyond_low = false, beyond_high = false;  ///< some values lie outside the range
};

/// Size of letters and lines for a picture of this width: 1 at 1024 pixels, never too small to read.
double figure_scale(int width);

/// White page with the picture on it; display-encoded, as the picture is.
RgbImage draw_figure(const RgbImage& picture, const Colormap&, const FigureLabels&);

}  // namespace marrow
