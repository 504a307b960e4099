// Integrals under the compact kernel along lines of one radius; internal to skeleton/.
#pragma once

#include "field/description/field_node.h"
#include "field/kernel/profile.h"
#include "field/skeleton/line_integral.h"
#include "field/skeleton/skeleton_sample.h"

namespace marrow {

/// On a line of the radius tau the kernel is w^(m/2), w = (l^2 - t^2) / rho^2, rho = R tau, l^2 = rho^2 - h^2, with
///   I(q) = integral of w^q dt,   (2q + 3) I(q+1) = [t w^(q+1)] + 2 (q+1) l^2/rho^2 I(q),
/// by parts, from I(0), the length, or I(-1/2), rho times the angle. Where little of the integral lies between the ends
/// these would cancel: there it is a sum over nodes.
class CompactChords {
 public:
  /// Of lines of a skeleton of that dimension.
  CompactChords(const Kernel&, int dimension);

  /// Adds `weight` times the integral and its derivatives. `across` goes from the foot of the point on the line to it,
  /// u along the line.   Precondition: line.slope == 0
  template <Derivatives>
  void add(const Line&, const Vec3d& across, const UnitVec3& u, double weight, SkeletonSample& sum) const;

 private:
  Kernel kernel_;
  Profile profile_;
  int dimension_;
};

}  // namespace marrow
