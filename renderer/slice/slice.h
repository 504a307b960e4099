// A field on an axis plane: its values, and a picture of them that a paper can print.
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "field/base/result.h"
#include "field/math/box3.h"
#include "field/math/vec3.h"
#include "renderer/output/picture.h"
#include "renderer/output/rgb_image.h"

namespace marrow {

struct SliceSample {
  double value = 0;
  Vec3d gradient;  ///< per scene unit
};

/// What is sampled; called by several threads at once.
struct SliceField {
  std::function<SliceSample(const Vec3d&)> at;
  /// The same field in a box, where samples take less time; null: they would not.
  std::function<SliceField(const Box3&)> within{};
};

/// A rectangle of the plane, in scene units; u to the right, v up (see slice_axes).
struct SliceWindow {
  double u0 = 0, v0 = 0, u1 = 0, v1 = 0;
  double width() const { return u1 - u0; }
  double height() const { return v1 - v0; }
};

/// The plane p[axis] = offset, and how to sample and paint it.
struct SliceRequest {
  int axis = 2;                                    ///< 0, 1, 2 for x, y, z
  double offset = 0;                               ///< scene units
  std::optional<SliceWindow> window;               ///< default: the object's bounds and a quarter of their size around
  int width = 1024;                                ///< pixels of the field; the height follows from the window
  std::optional<std::pair<double, double>> range;  ///< of the colours; default: automatic_range
  std::string colormap = "viridis";
  int threads = 0;  ///< 0: as many as the caller's arena has
  /// When it becomes true slice() ends soon, and its numbers mean nothing; it may be set by a signal handler.
  const std::atomic<bool>* interrupted = nullptr;
};

/// Parses "z=0", "x = -1.5". Error: anything else.
Result<std::pair<int, double>> parse_plane(const std::string&);

/// The axes that run right and up in the picture of a plane: x -> (y, z), y -> (x, z), z -> (x, y).
std::array<int, 2> slice_axes(int axis);

/// Values and gradients at the pixel centres, rows from the top.
struct SliceImage {
  int axis = 2;
  double offset = 0;
  double iso = 1;
  SliceWindow window;
  int width = 0, height = 0;
  std::vector<SliceSample> samples;

  double units_per_pixel() const { return window.width() / width; }
  const SliceSample& at(int x, int y) const {
    return samples[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

/// Errors: an axis other than 0..2, an empty window or one that is not finite, more than 2^26 pixels.
Result<SliceImage> slice(const SliceField&, double iso, const Box3& bounds, const SliceRequest&);

/// Range of colours that shows the surface and both its sides: 0 (or the least value, if below) to twice the iso-value,
/// because the fields of skeletons grow without bound at the skeleton and what a reader looks for is where f = iso.
std::pair<double, double> automatic_range(const SliceImage&);

/// The raw numbers: channels field.value, field.grad.X, field.grad.Y, field.grad.Z; plane, window and iso-value as
/// metadata.
Picture to_exr_picture(const SliceImage&);

struct SliceStyle {
  std::optional<std::pair<double, double>> range;
  std::string colormap = "viridis";
  std::string units;     ///< name of the scene unit for the scale bar; may be empty
  bool contours = true;  ///< thin lines at the ticks of the colour bar
  bool legend = true;    ///< axes, colour bar and scale bar around the picture, which grows by them
};

/// Display-encoded picture. Values outside the range take the end colours, NaN is magenta. The line f = iso is white
/// with a dark rim; lines and letters grow with the width of the picture.
/// Error: an unknown colour map.
Result<RgbImage> paint(const SliceImage&, const SliceStyle&);

}  // namespace marrow
