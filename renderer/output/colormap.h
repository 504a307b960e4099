// False colour: numbers from 0 to 1 as display-encoded colours.
// These go to the file as they are, never through a tone-mapped view, so that a reader can undo them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "field/base/result.h"

namespace marrow {

class Colormap {
 public:
  /// Error: an unknown name; the message lists the known ones.
  static Result<Colormap> named(std::string_view name);
  static std::vector<std::string> names();

  /// sRGB-encoded colour in 0..1 of t, clamped to 0..1 and interpolated between the entries; NaN is magenta.
  std::array<float, 3> operator()(double t) const;

 private:
  using Entry = std::array<std::uint8_t, 3>;
  explicit Colormap(std::span<const Entry> table) : table_(table) {}
  std::span<const Entry> table_;
};

}  // namespace marrow
