#include "field/trace/curve/iso_curve.h"

#include <algorithm>

#include "field/blend/correction/correction.h"

namespace marrow {
namespace {

// Of the ends of a range, which tell of cubes alone.
constexpr int entry_count = 256;

IsoTable end_of_range(const Correction& like, double alpha) {
  return {Correction(like.degree(), alpha, like.cavity(), like.projection()), alpha, entry_count};
}

}  // namespace

IsoCurve::IsoCurve(const Correction& correction, double alpha)
    : IsoCurve(correction, alpha, UpToGradient{usual_gradient(correction)}) {}

IsoCurve::IsoCurve(const Correction& correction, double alpha, UpToGradient up_to) : least_(alpha), most_(alpha) {
  ends_.emplace_back(correction, alpha, up_to);
}

IsoCurve::IsoCurve(const Correction& correction, double least, double most)
    : IsoCurve(correction, least, most, UpToGradient{usual_gradient(correction)}) {}

IsoCurve::IsoCurve(const Correction& correction, double least, double most, UpToGradient up_to)
    : least_(least), most_(most), angles_(correction, least, most, up_to) {
  for (const double alpha : {least, most}) ends_.push_back(end_of_range(correction, alpha));
}

bool IsoCurve::outside(double x_low, double x_high, double y_high) const {
  return std::ranges::all_of(ends_, [&](const IsoTable& end) { return end.outside(x_low, x_high, y_high); });
}

bool IsoCurve::inside(double x_low, double y_low) const {
  return std::ranges::all_of(ends_, [&](const IsoTable& end) { return end.inside(x_low, y_low); });
}

}  // namespace marrow
