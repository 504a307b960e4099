// The normal at a hit, and a point beside it from which rays can leave.
#include <algorithm>
#include <cmath>
#include <limits>

#include "field/math/elementary.h"
#include "field/trace/blend_tracer_state.h"

namespace marrow {
namespace {

Vec3d vec(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

// The share of the range of angles at a hit, where alpha varies.
struct HitShare {
  ShareAt at;
  double error;   // by which it may be off, in `at` or beside it
  double growth;  // its changes on a step of h distances are at most 1 / (1 - growth h) times what `at` bounds
};

// IsoCurve::margin() for all shares that alpha may have on a step along the normal: C is largest at one end of them,
// see angle_rows.h.
double margin_of_shares(const HitShare& share, const Vec3d& normal, double step, double nearest, const IsoCurve& iso,
                        double x, double y, int degree) {
  const bool upward = integer_power(x, degree) > integer_power(y / (degree - 1), degree - 1);
  const double left = 1 - share.growth * step / nearest;
  if (!(left > 0.1) || !(share.at.bend < std::numeric_limits<double>::infinity()))
    return iso.margin(x, y, upward ? 1 : 0);
  const double move = dot(share.at.gradient, normal) * step, bend = share.at.bend * step * step;
  return iso.margin(
      x, y,
      share.at.share +
          (upward ? std::max(0.0, move + bend) + share.error : std::min(0.0, move - bend) - share.error) / left);
}

HitShare share_of(const Block& block, const Vec3d& place, const PointField& f, int degree) {
  const BlockLevel& fine = block.fine();
  // Twice, since a ray may start in a neighbour.
  const auto error = [&](double share, double angle_error) {
    return 2 * (angle_error + share * fine.f_error) / std::max(1e-20F, f.f);
  };
  if (block.patches() != nullptr) {
    const ShareAt at = block.share(place);
    // What strands give is within 1e-4 at 99 of 100 random places (an estimate).
    return {at, error(at.share, at.error) + 2e-4, 0};
  }
  const auto share = static_cast<double>(f.share);
  return {{.share = share, .gradient = vec(f.share_gradient), .bend = static_cast<double>(f.share_bend)},
          error(share, fine.angle_error) + 1e-5,  // floats are rounded
          6.0 * degree + 2};
}

// How far to go along the normal until the field is certainly below 1: f and |G| there are bounded by their Taylor
// polynomials and the remainders B3 and B4 of tracing.md, with series sums up to twice their values at 0 (a step of at
// most a tenth of the distance). Twice the errors of the block, since a ray may start in its neighbour. Where no step
// is proved, beside a touch of the surface with itself, the one that comes nearest to it. Block coordinates.
double step_outside(const PointField& f, const HitShare& share, const Vec3d& normal, const Vec3d& bent,
                    const BlockLevel& fine, const IsoCurve& iso, int degree) {
  const double slope = dot(vec(f.gradient), normal), n = degree;
  // As march.h: sums of floats, and positions in float.
  const double raise = 1 + 2 * (4e-6 + 2e-7 * (n + 1) / f.nearest);
  // So that rays get away from where rounding leaves doubts, or, where alpha varies, what tables and shares are off by:
  // 7e-5 was met at a kink.
  const double enough = iso.views().size() > 1 ? 1.5e-4 : 2e-5;
  // Near a single skeleton a step of s distances lowers C by s (n - 1): shorter ones are not enough.
  const double first = iso.views().size() > 1 ? 3.2e-5 : 8e-6;
  // Where no rule is certified, beside the point of a cone, the stated error may be infinite and no step would be best.
  constexpr double most_error = 1e-3;
  const double f_error = std::min(fine.f_error, most_error), g_error = std::min(fine.gradient_error, most_error);
  double best = 0, largest = -std::numeric_limits<double>::infinity();
  for (double step = first * f.nearest; step < 0.1 * f.nearest; step *= 2) {
    const double bend = f.second * n * (n + 1) * step * step;
    const double x = f.f + slope * step + bend + 2 * f_error, x_low = f.f + slope * step - bend - 2 * f_error;
    const double y = length(vec(f.si_gradient) + bent * step) + f.third * (n + 1) * (n + 2) * step * step + 2 * g_error;
    double margin = iso.views().size() > 1
                        ? margin_of_shares(share, normal, step, f.nearest, iso, x * raise, y * raise, degree)
                        : iso.margin(x * raise, y * raise);
    if (iso.two_sided()) margin = std::min(margin, iso.margin(std::max(0.0, x_low / raise), y * raise));
    if (margin > enough) return step;
    if (margin > largest) {
      largest = margin;
      best = step;
    }
  }
  return best;
}

}  // namespace

SurfacePoint BlendTracer::surface_at(std::size_t tile, const Vec3d& position) const {
  const CellTree::Cell cell = state_->tree.nearest_cell(tile, position);
  return surface_at(block(*cell.tile, cell.slot), position);
}

SurfacePoint BlendTracer::surface_at(const Block& b, const Vec3d& position) const {
  const Vec3d x = (position - b.center()) / b.half();
  const float local[3] = {static_cast<float>(x.x), static_cast<float>(x.y), static_cast<float>(x.z)};
  const PointField f = state_->kernels.point_field(b.fine().level, state_->field.degree, local);
  const Vec3d gradient = vec(f.gradient), g = vec(f.si_gradient);
  const float* h = f.hessian;
  const auto bend = [&](const Vec3d& v) {  // H v
    return Vec3d{h[0] * v.x + h[3] * v.y + h[4] * v.z, h[3] * v.x + h[1] * v.y + h[5] * v.z,
                 h[4] * v.x + h[5] * v.y + h[2] * v.z};
  };
  const double y = length(g);
  const HitShare share = state_->range ? share_of(b, x, f, state_->field.degree) : HitShare{};
  const IsoCurve::Gradient c = state_->iso.gradient(f.f, y, share.at.share);
  Vec3d growth = gradient * c.x + bend(g) * (c.y / std::max(y, 1e-12));
  if (state_->range) growth += share.at.gradient * c.share;
  SurfacePoint out;
  out.normal = normalize(-growth);
  out.outside = position + out.normal * (b.half() * step_outside(f, share, out.normal, bend(out.normal), b.fine(),
                                                                 state_->iso, state_->field.degree));
  return out;
}

}  // namespace marrow
