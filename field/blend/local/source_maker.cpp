#include "field/blend/local/source_maker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "field/blend/radius_marks.h"
#include "field/kernel/inverse_family.h"
#include "field/kernel/profile.h"
#include "field/math/elementary.h"
#include "field/math/gauss_rule.h"
#include "field/skeleton/distance.h"
#include "field/skeleton/parts.h"
#include "field/skeleton/radii.h"

namespace marrow {
namespace {

// Over half the diagonal of the box: what is nearer has no useful bounds there, and is left to the boxes inside it.
constexpr double nearest = 0.4;
// And longer parts than this are cut.
constexpr double largest = 1;
// A triangle that is longer than so many of its distances stays a closed form: beside it points would be 10^4 and more,
// in every box anew.
constexpr double most_over_distance = 4;
// Parts of a primitive are halves of halves down to this; and where one is so short over its distance that rules for it
// take few nodes, if there are any, there are none for its halves either.
constexpr int deepest = 12;
constexpr double shortest = 0.01;

struct Nodes {
  std::span<const double> positions, weights;
};

template <std::size_t... Counts>
Nodes rule_of(int count, std::index_sequence<Counts...>) {
  static constexpr std::array<Nodes, sizeof...(Counts)> rules{
      Nodes{gauss_rule<Counts + 1>.nodes, gauss_rule<Counts + 1>.weights}...};
  return rules[static_cast<std::size_t>(count - 1)];
}
Nodes rule_of(int count) { return rule_of(count, std::make_index_sequence<most_rule_nodes>()); }

// A lower bound: that of the circle, or of a ball around the arc.
double least_distance(const ArcSkeleton& s, const Vec3d& p) {
  const double half = 0.5 * (s.end - s.begin);
  return std::max(distance_to(s, p), length(p - place_at(s, s.begin + half)) - s.major * half);
}
double least_distance(const auto& s, const Vec3d& p) { return distance_to(s, p); }

}  // namespace

SourceMaker::SourceMaker(const BlendField& blend, const Box3& box, bool marked, double error, double share)
    : sources(blend.degree, marked),
      degree_(blend.degree),
      center_(box.center()),
      rho_(0.5 * length(box.size())),
      error_(error),
      share_(share),
      marked_(marked),
      reference_(reference_radius(blend)) {
  const Kernel kernel = kernel_of(blend);
  const bool is_cauchy = blend.kernel == KernelFamily::Cauchy;
  if (is_cauchy) per_lift_ = 1 / blend.kernel_shape;
  for (int dimension = 0; dimension < 3; ++dimension) {
    const Profile profile(kernel, dimension);
    const double shape = is_cauchy ? integer_power(per_lift_, profile.degree()) : 1;
    unit_[dimension] = shape / profile.normalisation();
  }
}

// From anywhere in the box.
SourceMaker::View SourceMaker::seen(double distance, double least_radius) const {
  const double clear = distance - rho_, lift = per_lift_ * least_radius;
  // Under the Cauchy kernel a skeleton is never nearer than its lift.
  const double lifted = std::sqrt(std::max(0.0, clear) * std::max(0.0, clear) + lift * lift);
  return {lifted, lifted < nearest * rho_};
}

double SourceMaker::allowed(double mass, double radius, double distance, int m) const {
  const double field = mass * integer_power(radius, degree_ - 1) / integer_power(distance, m);
  return error_ * std::max(std::min(1.0, field), share_) / field;
}

void SourceMaker::note(double mass, double radius, double distance, int m, double relative) {
  const double error = relative * mass * integer_power(radius, degree_ - 1) / integer_power(distance, m);
  f_error += error;
  S_error += error * m * radius / distance;
}

void SourceMaker::emit(SourceSums& out, const Vec3d& at, double weight, double radius, int dimension) const {
  const double lift = per_lift_ * radius;
  out.add({.at = at,
           .weight = unit_[dimension] * weight * integer_power(radius, degree_ - 1),
           .radius = radius,
           .lift_squared = lift * lift,
           .mark = mark_});
}

template <class Skeleton, class Add>
void SourceMaker::add_all(const PrimitiveList<Skeleton>& list, const Add& add) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (marked_) mark_ = radius_mark(list, i, reference_);
    add(list.skeletons[i]);
  }
}

template <class Skeleton>
void SourceMaker::leave(const Skeleton& s, PrimitiveList<Skeleton>& rest) const {
  rest.skeletons.push_back(s);
  if (marked_) rest.log_radii.push_back(mark_);
}

void SourceMaker::add(const PointSkeleton& s) {
  if (seen(distance_to(s, center_), s.radius).too_near) leave(s, rest_points);
  else emit(sources.points, s.at, 1, s.radius, 0);
}

// place(t) for t from 0 to 1.
template <class Curve, class Place>
bool SourceMaker::add_curve(const Curve& s, double half_angle, double distance, const Place& place) {
  const double size = measure(s), radius = largest_radius(s), half = 0.5 * (radius - least_radius(s));
  const double mass = unit_[1] * size;
  const int m = sources.curves.exponent();
  const double relative = allowed(mass, radius, distance, m);
  const auto nodes = rule_nodes({.half_length = 0.5 * size,
                                 .half_angle = half_angle,
                                 .half_lift = per_lift_ * half,
                                 .radius = radius - half,
                                 .half_radius = half,
                                 .power = degree_ - 1,
                                 .exponent = m},
                                distance, relative);
  if (!nodes) return false;
  const Nodes rule = rule_of(*nodes);
  for (std::size_t k = 0; k < rule.positions.size(); ++k) {
    const double t = rule.positions[k];
    emit(sources.curves, place(t), size * rule.weights[k], s.radius_from + (s.radius_to - s.radius_from) * t, 1);
  }
  note(mass, radius, distance, m, relative);
  return true;
}

bool SourceMaker::add_part(const SegmentSkeleton& s, double distance) {
  return add_curve(s, 0, distance, [&](double t) { return lerp(s.from, s.to, t); });
}

bool SourceMaker::add_part(const ArcSkeleton& s, double distance) {
  const double angle = s.end - s.begin;
  return add_curve(s, 0.5 * angle, distance, [&](double t) { return place_at(s, s.begin + angle * t); });
}

// Lines from one corner to the opposite side: at a + u (b - a) + u v (c - b) the measure is 2 area u du dv. Each of the
// two rules may err by half.
bool SourceMaker::add_part(const TriangleSkeleton& s, double distance) {
  const auto& [a, b, c] = s.vertices;
  const double radius = largest_radius(s), half = 0.5 * (radius - least_radius(s)), mass = unit_[2] * measure(s);
  const int m = sources.surfaces.exponent();
  const double relative = allowed(mass, radius, distance, m);
  RulePiece line{.half_length = 0.5 * length(c - b),
                 .half_lift = per_lift_ * half,
                 .radius = radius - half,
                 .half_radius = half,
                 .power = degree_ - 1,
                 .exponent = m};
  const auto across = rule_nodes(line, distance, 0.5 * relative);
  line.half_length = 0.5 * std::max(length(b - a), length(c - a));
  line.widens = true;
  const auto along = rule_nodes(line, distance, 0.5 * relative);
  if (!across || !along) return false;
  const Nodes us = rule_of(*along), vs = rule_of(*across);
  for (std::size_t i = 0; i < us.positions.size(); ++i)
    for (std::size_t k = 0; k < vs.positions.size(); ++k) {
      const double u = us.positions[i], uv = u * vs.positions[k];
      emit(sources.surfaces, a + (b - a) * u + (c - b) * uv, 2 * measure(s) * u * us.weights[i] * vs.weights[k],
           s.radii[0] + (s.radii[1] - s.radii[0]) * u + (s.radii[2] - s.radii[1]) * uv, 2);
    }
  note(mass, radius, distance, m, relative);
  return true;
}

// Parts may be away where the whole is near; those that are about as large as the box are left to smaller boxes.
template <class Skeleton>
void SourceMaker::divide(const Skeleton& whole, PrimitiveList<Skeleton>& rest) {
  if (!(measure(whole) > 0)) return;
  if constexpr (std::same_as<Skeleton, TriangleSkeleton>)
    if (most_over_distance * seen(least_distance(whole, center_), least_radius(whole)).lifted < extent(whole)) {
      leave(whole, rest);
      return;
    }
  std::vector<std::pair<Skeleton, int>> open{{whole, 0}};
  while (!open.empty()) {
    const auto [s, depth] = open.back();
    open.pop_back();
    const View view = seen(least_distance(s, center_), least_radius(s));
    if (!view.too_near && add_part(s, view.lifted)) continue;
    const bool is_short = extent(s) < (view.too_near ? largest * rho_ : shortest * view.lifted);
    if (depth == deepest || is_short) {
      leave(s, rest);
      continue;
    }
    for (const Skeleton& part : parts(s)) open.push_back({part, depth + 1});
  }
}

void SourceMaker::add(const PrimitiveList<PointSkeleton>& list) {
  add_all(list, [&](const PointSkeleton& s) { add(s); });
}
void SourceMaker::add(const PrimitiveList<SegmentSkeleton>& list) {
  add_all(list, [&](const SegmentSkeleton& s) { divide(s, rest_segments); });
}
void SourceMaker::add(const PrimitiveList<ArcSkeleton>& list) {
  add_all(list, [&](const ArcSkeleton& s) { divide(s, rest_arcs); });
}
void SourceMaker::add(const PrimitiveList<TriangleSkeleton>& list) {
  add_all(list, [&](const TriangleSkeleton& s) { divide(s, rest_triangles); });
}

}  // namespace marrow
