#include "field/trace/sources/far_field.h"

#include <algorithm>
#include <cmath>

namespace marrow {
namespace {

constexpr int highest_degree = highest_far_degree + 1;

}  // namespace

void MomentTable::add(const float* f, const float* potential, FarField& far) const {
  far.degree = std::max(far.degree, far_degree_);
  const auto add = [&](const float* sums, int degree, Polynomial& to) {
    std::array<double, MomentSeries::count(highest_degree)> moments{};
    std::copy(sums, sums + monomials_to_degree(degree), moments.begin());
    series_.complete(moments, degree);
    series_.add_to(to, moments, degree);
  };
  add(f, far_degree_, far.f);
  add(potential, far_degree_ + 1, far.potential);
}

FarField FarField::of_child(int octant) const {
  FarField child = *this;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double shift = (octant >> axis) & 1 ? 0.5 : -0.5;
    move_axis<highest_degree>(child.f, degree, axis, shift, 0.5);
    move_axis<highest_degree>(child.potential, degree + 1, axis, shift, 0.5);
  }
  for (double& c : child.potential) c *= 2;  // F / half: half is now half as long
  return child;
}

FarField::Bounds FarField::bounds() const {
  Bounds b{f[0], f_error, {potential[1], potential[2], potential[3]}, gradient_error};
  for (std::size_t i = 1; i < monomials_to_degree(degree); ++i) b.f_variation += std::fabs(f[i]);
  // |grad x^a y^b z^c| <= a + b + c on the cube
  for (std::size_t i = 4; i < monomials_to_degree(degree + 1); ++i)
    b.gradient_variation += std::fabs(potential[i]) * monomials[i].degree();
  return b;
}

}  // namespace marrow
