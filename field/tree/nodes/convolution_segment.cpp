#include "field/tree/nodes/convolution_segment.h"

namespace marrow {

Box3 ConvolutionSegment::extent(double level) const {
  const double R = std::max(radius.front(), radius.back()), length = marrow::length(to - from);
  const double far = std::min(R / std::sqrt(level), pow(length * R * R / (2 * level), 1.0 / 3));
  Box3 box;
  box.include(from);
  box.include(to);
  return box.padded(far * (1 + 1e-9));
}

}  // namespace marrow
