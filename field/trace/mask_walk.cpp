#include "field/trace/mask_walk.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace marrow {
namespace {
constexpr int cells_per_axis = 4;
constexpr double cell_size = 2.0 / cells_per_axis;
}  // namespace

MaskWalk::MaskWalk(std::uint64_t mask, const Vec3d& origin, const Vec3d& direction, const Vec3d& inverse_direction,
                   double t0, double t1)
    : mask_(mask), t_(t0), end_(t1) {
  for (std::size_t i = 0; i < 3; ++i) {
    const double at = (origin[i] + direction[i] * t0 + 1) * (1 / cell_size);
    cell_[i] = std::clamp(static_cast<int>(at), 0, cells_per_axis - 1);
    step_[i] = direction[i] > 0 ? 1 : -1;
    delta_[i] = cell_size * std::fabs(inverse_direction[i]);
    const double plane = -1 + (cell_[i] + (step_[i] > 0 ? 1 : 0)) * cell_size;
    crossing_[i] =
        direction[i] == 0 ? std::numeric_limits<double>::infinity() : (plane - origin[i]) * inverse_direction[i];
  }
}

bool MaskWalk::advance() {
  int axis = crossing_[0] < crossing_[1] ? 0 : 1;
  if (crossing_[2] < crossing_[axis]) axis = 2;
  t_ = std::max(t_, crossing_[axis]);
  if (t_ >= end_) return false;
  crossing_[axis] += delta_[axis];
  cell_[axis] += step_[axis];
  return cell_[axis] >= 0 && cell_[axis] < cells_per_axis;
}

bool MaskWalk::next(Stretch& out) {
  while (!done_ && !marked())
    if (!advance()) done_ = true;
  if (done_) return false;
  out.begin = t_;
  while (!done_ && marked())
    if (!advance()) done_ = true;
  out.end = done_ ? end_ : t_;
  return true;
}

}  // namespace marrow
