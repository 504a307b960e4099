#include "field/trace/sources/kept_far_field.h"

#include <algorithm>
#include <cmath>

namespace marrow {
namespace {

std::size_t field_count(int degree) { return monomials_to_degree(degree); }
std::size_t potential_count(int degree) { return monomials_to_degree(degree + 1); }

}  // namespace

KeptFarField::KeptFarField(const FarField& far)
    : degree_(far.degree), f_error_(far.f_error), gradient_error_(far.gradient_error) {
  coefficients_.reserve(field_count(degree_) + potential_count(degree_));
  // Returns by how much the coefficient is off then.
  const auto keep = [this](double coefficient) {
    coefficients_.push_back(static_cast<float>(coefficient));
    return std::fabs(coefficient - static_cast<double>(coefficients_.back()));
  };
  for (std::size_t i = 0; i < field_count(degree_); ++i) f_error_ += keep(far.f[i]);
  // |grad x^a y^b z^c| <= a + b + c on the cube
  for (std::size_t i = 0; i < potential_count(degree_); ++i)
    gradient_error_ += keep(far.potential[i]) * monomials[i].degree();
}

FarField KeptFarField::whole() const {
  FarField far{.degree = degree_, .f_error = f_error_, .gradient_error = gradient_error_};
  if (coefficients_.empty()) return far;
  const auto potential = coefficients_.begin() + static_cast<std::ptrdiff_t>(field_count(degree_));
  std::copy(coefficients_.begin(), potential, far.f.begin());
  std::copy(potential, coefficients_.end(), far.potential.begin());
  return far;
}

}  // namespace marrow
