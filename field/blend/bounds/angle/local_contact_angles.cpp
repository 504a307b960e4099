#include "field/blend/bounds/angle/local_contact_angles.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "field/blend/bounds/angle/field_weight.h"
#include "field/blend/gather.h"
#include "field/blend/primitive_visit.h"
#include "field/blend/radius_marks.h"
#include "field/math/elementary.h"
#include "field/skeleton/distance.h"
#include "field/skeleton/parts.h"

namespace marrow {
namespace {

constexpr double inf = Box3::inf;
// Of sums and of what cancels in the variance; radii differ by e^20 at most.
constexpr double rounded = 1e-8;
// Where near fields, or fields, are outside of this the rule tells nothing, or takes 1 for the crowd.
constexpr double least_near_field = 1e-240, least_field = 1e-290, largest_field = 0.9 * field_ceiling;

// The primitives of a blend that have a field in the ball.
struct Terms {
  std::vector<FieldWeight> fields, near;
  std::vector<double> radii;  // logarithms
};

// The near field of a skeleton is a sum of so high powers of distances.
int near_power(const auto& skeleton) { return LocalContact::near_degree - 1 + dimension_of(skeleton); }

Terms terms_of(const BlendField& blend, const SumBounds& sum, const std::vector<SkeletonSample>& near) {
  Terms terms;
  std::size_t k = 0;
  visit_parts(blend, sum.parts(), [&](const SumBounds::Part& part, const auto& list, std::size_t i) {
    const SkeletonSample& near_field = near[k++];
    if (!part.counts()) return;
    const auto& skeleton = list.skeletons[i];
    if (blend.local_contact->adapts_to_density())
      terms.near.push_back(
          weight_of({.sample = near_field, .distance = distance_to(skeleton, sum.center()), .m = near_power(skeleton)},
                    sum.rho()));
    terms.fields.push_back(weight_of(part, sum.rho()));
    terms.radii.push_back(radius_mark(list, i, 1));
  });
  return terms;
}

// Each without the factor that all have in common, if logarithms are known.
std::vector<MeanTerm> without(const Vec3d& common, const std::vector<FieldWeight>& fields, double rho) {
  std::vector<MeanTerm> terms;
  terms.reserve(fields.size());
  for (const FieldWeight& f : fields) terms.push_back(f.term(common, rho));
  return terms;
}

bool have_logarithms(const std::vector<FieldWeight>& fields) {
  return std::ranges::all_of(fields, [](const FieldWeight& f) { return f.log.has_value(); });
}

// Of the mean of values that do not vary, which is `mean` in the middle.
MeanChange change_of(std::vector<MeanTerm> terms, const std::vector<double>& values, double mean, double rho) {
  const auto [least, most] = std::ranges::minmax(values);
  for (std::size_t i = 0; i < terms.size(); ++i)
    terms[i].apart = std::fabs(values[i] - mean) + middle_is_off * (std::fabs(values[i]) + std::fabs(mean));
  return mean_change(terms, (most - least) * (1 + middle_is_off), rho);
}

// What a number that the rule is told may be in the ball, and its largest derivatives there.
struct Told {
  Interval value;
  double slope = 0, bend = 0;
};

// The derivative of the spread, a variance, is the covariance of grad ln f_i with the squared deviations, at most twice
// the steepest of these times itself.
Told spread_by_steepest(double in_middle, double log_slope, double rho) {
  const double rate = 2 * log_slope, grows = rate * rho < 50 ? exp(rate * rho) * (1 + 1e-9) : inf;
  const Interval value{std::max(0.0, in_middle - rounded) / grows, (in_middle + rounded) * grows};
  return {value, rate * value.hi * (1 + 1e-9), inf};
}

Told spread_by_means(const Terms& terms, const std::vector<MeanTerm>& weights, const Told& at_most, double in_middle,
                     double rho) {
  double total = 0, mean = 0, mean_square = 0;
  for (std::size_t i = 0; i < terms.radii.size(); ++i) {
    total += terms.fields[i].value;
    mean += terms.fields[i].value * terms.radii[i];
  }
  mean /= total;
  std::vector<double> apart = terms.radii, squares;
  squares.reserve(apart.size());
  for (std::size_t i = 0; i < apart.size(); ++i) {
    apart[i] -= mean;
    squares.push_back(apart[i] * apart[i]);
    mean_square += terms.fields[i].value * squares[i] / total;
  }
  const MeanChange A = change_of(weights, squares, mean_square, rho), B = change_of(weights, apart, 0, rho);
  const double moved = B.slope * rho, slope = std::min(at_most.slope, 4 * (A.slope + 2 * moved * B.slope));
  const double bend = 4 * (A.bend + 2 * B.slope * B.slope + 2 * moved * B.bend);
  const double by = slope < inf ? slope * rho + rounded : inf;
  return {clamped({in_middle - by, in_middle + by}, at_most.value), slope, bend};
}

// `slope` of the logarithm in the middle, and its `bend` in the ball.
Told crowd_in(double in_middle, double slope, double bend, double rho) {
  const double steep = slope * (1 + middle_is_off) + bend * rho;
  if (!(steep * rho < 50)) return {{1, inf}, inf, inf};
  const double factor = exp(steep * rho) * (1 + rounded), most = in_middle * factor;
  return {{in_middle / factor, most}, most * steep, most * (steep * steep + bend)};
}

// Of fields and of near fields: |grad ln| of any of them in the ball.
struct Steepest {
  double field, near = 0;
};

double near_log_slope(const BlendField& blend, const SumBounds& sum) {
  double steepest = 0;
  blend.for_each_list([&](const auto& list) {
    for (const auto& s : list.skeletons) {
      const double distance = distance_to(s, sum.center()) - sum.rho();
      steepest = std::max(steepest, distance > 0 ? near_power(s) / distance * (1 + 1e-9) : inf);
    }
  });
  return steepest;
}

Told crowd_by_steepest(const LocalContact& rule, const Neighbourhood& place, const Steepest& steepest, double rho) {
  const double grows = steepest.near * rho < 50 ? exp(steepest.near * rho) : inf;
  if (!(place.near_field / grows > least_near_field && place.near_field * grows < largest_field))
    return {{1, inf}, inf, inf};
  const double slope = rule.crowd_exponent() * (steepest.field + rule.crowd_share() * steepest.near);
  Told told = crowd_in(rule.crowd(place), slope, 0, rho);
  told.bend = inf;
  return told;
}

Told crowd_by_logarithms(const LocalContact& rule, const Neighbourhood& place, const LogWeight& field,
                         const std::vector<FieldWeight>& near_fields, const Told& at_most, double rho) {
  const double share = rule.crowd_share(), exponent = rule.crowd_exponent();
  const Vec3d near_slope = place.near_gradient / place.near_field;
  const LogWeight near = log_of_sum(near_slope, without(near_slope, near_fields, rho));
  const double bend = exponent * (field.bend + share * near.bend);
  if (!(bend < inf)) return at_most;
  const Told told = crowd_in(rule.crowd(place), exponent * length(field.slope - near.slope * share), bend, rho);
  return {clamped(told.value, at_most.value), std::min(told.slope, at_most.slope), told.bend};
}

MeanChange angle_change(const LocalContact::Within& rule, const Told& spread, const Told& crowd) {
  const auto times = [](double factor, double x) { return factor == 0 ? 0 : factor * x; };
  const double slope = times(rule.by_spread, spread.slope) + times(rule.by_crowd, crowd.slope);
  if (rule.may_be_cut) return {slope, inf};
  return {slope, times(rule.by_spread, spread.bend) + times(rule.by_spread_twice, spread.slope * spread.slope) +
                     times(rule.by_crowd, crowd.bend) + times(rule.by_crowd_twice, crowd.slope * crowd.slope)};
}

bool is_known(const SumBounds& sum) {
  const Interval f = sum.f();
  return !sum.unbounded() && sum.takeovers().empty() && f.lo > least_field && f.hi < largest_field;
}

Interval all_angles(const BlendField& blend) { return hull(blend.local_contact->range(), blend.alpha); }
AngleBounds unknown_angles(const BlendField& blend, const SumBounds& sum) {
  return angles_around({}, {inf, inf}, all_angles(blend), sum);
}

// What the rule is told.
struct ToldOfBoth {
  Told spread{.value = 0}, crowd{.value = 1};
};

ToldOfBoth by_steepest(const LocalContact& rule, const Neighbourhood& place, const Steepest& steepest, double rho) {
  ToldOfBoth told;
  if (rule.adapts_to_radii()) told.spread = spread_by_steepest(place.spread, steepest.field, rho);
  if (rule.adapts_to_density()) told.crowd = crowd_by_steepest(rule, place, steepest, rho);
  return told;
}

AngleBounds angles_by(const BlendField& blend, const Neighbourhood& place, const ToldOfBoth& told,
                      const SumBounds& sum) {
  const LocalContact& rule = *blend.local_contact;
  const LocalContact::Within within = rule.within(told.spread.value, told.crowd.value);
  return angles_around(rule.at(place), angle_change(within, told.spread, told.crowd),
                       clamped(within.alpha, all_angles(blend)), sum);
}

}  // namespace

AngleBounds local_contact_angles(const BlendField& blend, const Neighbourhood& place, double near_log_slope,
                                 const SumBounds& sum) {
  if (!is_known(sum)) return unknown_angles(blend, sum);
  const Steepest steepest{sum.log_slope(), near_log_slope};
  return angles_by(blend, place, by_steepest(*blend.local_contact, place, steepest, sum.rho()), sum);
}

AngleBounds local_contact_angles(const BlendField& blend, const SumBounds& sum) {
  // Where logarithms may change by more over the box, how fast their slopes change tells nothing.
  constexpr double most_change = 0.5;
  const LocalContact& rule = *blend.local_contact;
  const double rho = sum.rho();
  if (!is_known(sum)) return unknown_angles(blend, sum);
  const auto [place, near] = parts_around(blend, sum.center(), sum.parts());
  const Steepest steepest{sum.log_slope(), rule.adapts_to_density() ? near_log_slope(blend, sum) : 0};
  ToldOfBoth told = by_steepest(rule, place, steepest, rho);
  auto& [spread, crowd] = told;
  // Under the compact kernel they have no bound.
  const double changes = std::max(steepest.field < inf ? steepest.field : 0, steepest.near) * rho;
  if (changes < most_change) {
    const Terms terms = terms_of(blend, sum, near);
    const bool by_logarithms = have_logarithms(terms.fields);
    const Vec3d common = by_logarithms ? place.field_gradient / place.field : Vec3d{};
    const std::vector<MeanTerm> weights = without(common, terms.fields, rho);
    if (rule.adapts_to_radii()) spread = spread_by_means(terms, weights, spread, place.spread, rho);
    if (rule.adapts_to_density() && by_logarithms && crowd.slope < inf)
      crowd = crowd_by_logarithms(rule, place, log_of_sum(common, weights), terms.near, crowd, rho);
  }
  return angles_by(blend, place, told, sum);
}

}  // namespace marrow
