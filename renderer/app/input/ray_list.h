// Rays to trace, from text.
#pragma once

#include <istream>
#include <limits>
#include <string>
#include <vector>

#include "field/base/result.h"
#include "field/math/ray.h"
#include "renderer/scene/source_cache.h"

namespace marrow {

/// origin + t direction, t_min <= t <= t_max, with a direction of any length but 0.
struct ListedRay {
  Vec3d origin, direction;
  double t_min = 0;
  double t_max = std::numeric_limits<double>::infinity();

  /// The same as the tracer takes it, whose t is a length: `unit()` times as large.
  Ray ray() const;
  /// |direction|, also where its square is beyond doubles.
  double unit() const;
  /// The t of a place so far along that ray.
  double t_of(double distance) const;
};

/// One ray a line: its origin, its direction and, if wanted, t_min and t_max, the latter a number or `inf`; as
/// read_rows() reads lines. Errors: every line that is something else, has a direction of 0, or 0 <= t_min <= t_max
/// does not hold.
Result<std::vector<ListedRay>> read_rays(std::istream&, const std::string& name, SourceCache& sources);

}  // namespace marrow
