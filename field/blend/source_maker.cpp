#include "field/blend/source_maker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "field/kernel/inverse_family.h"
#include "field/kernel/profile.h"
#include "field/math/elementary.h"
#include "field/math/gauss_rule.h"
#include "field/skeleton/distance.h"
#include "field/skeleton/radii.h"

namespace marrow {
namespace {

// Over half the diagonal of the box: what is nearer is left to the boxes inside it. There distances are up to three
// times as large, and rules shorter.
constexpr double nearest = 0.5;
// Parts of a primitive are halves of halves down to this.
constexpr int deepest = 12;

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

double area(const TriangleSkeleton& s) {
  return 0.5 * length(cross(s.vertices[1] - s.vertices[0], s.vertices[2] - s.vertices[0]));
}

std::array<SegmentSkeleton, 2> parts(const SegmentSkeleton& s) {
  const Vec3d middle = lerp(s.from, s.to, 0.5);
  const double radius = 0.5 * (s.radius_from + s.radius_to);
  return {SegmentSkeleton{s.from, middle, s.radius_from, radius}, SegmentSkeleton{middle, s.to, radius, s.radius_to}};
}
std::array<ArcSkeleton, 2> parts(const ArcSkeleton& s) {
  ArcSkeleton a = s, b = s;
  a.end = b.begin = 0.5 * (s.begin + s.end);
  a.radius_to = b.radius_from = 0.5 * (s.radius_from + s.radius_to);
  return {a, b};
}
std::array<TriangleSkeleton, 4> parts(const TriangleSkeleton& s) {
  const auto& v = s.vertices;
  const auto& r = s.radii;
  const Vec3d ab = lerp(v[0], v[1], 0.5), bc = lerp(v[1], v[2], 0.5), ca = lerp(v[2], v[0], 0.5);
  const double rab = 0.5 * (r[0] + r[1]), rbc = 0.5 * (r[1] + r[2]), rca = 0.5 * (r[2] + r[0]);
  return {TriangleSkeleton{{v[0], ab, ca}, {r[0], rab, rca}}, TriangleSkeleton{{ab, v[1], bc}, {rab, r[1], rbc}},
          TriangleSkeleton{{ca, bc, v[2]}, {rca, rbc, r[2]}}, TriangleSkeleton{{bc, ca, ab}, {rbc, rca, rab}}};
}

Vec3d place(const ArcSkeleton& s, double angle) {
  const auto [sine, cosine] = sincos(angle);
  return s.center + s.axis1 * (s.major * cosine) + s.axis2 * (s.major * sine);
}

// A lower bound: that of the circle, or of a ball around the arc.
double least_distance(const ArcSkeleton& s, const Vec3d& p) {
  const double half = 0.5 * (s.end - s.begin);
  return std::max(distance_to(s, p), length(p - place(s, s.begin + half)) - s.major * half);
}
double least_distance(const auto& s, const Vec3d& p) { return distance_to(s, p); }

// Calls add for the whole, or for as large parts of it as it takes; what it never takes goes to the rest.
template <class Skeleton, class Add, class Rest>
void divided(const Skeleton& whole, const Add& add, const Rest& rest) {
  std::vector<std::pair<Skeleton, int>> open{{whole, 0}};
  while (!open.empty()) {
    const auto [s, depth] = open.back();
    open.pop_back();
    if (add(s)) continue;
    if (depth == deepest) {
      rest(s);
      continue;
    }
    for (const Skeleton& part : parts(s)) open.push_back({part, depth + 1});
  }
}

}  // namespace

SourceMaker::SourceMaker(const BlendField& blend, const Box3& box, double relative_error, double share)
    : points(kernel_degree(blend.degree, 0)),
      curves(kernel_degree(blend.degree, 1)),
      surfaces(kernel_degree(blend.degree, 2)),
      degree_(blend.degree),
      center_(box.center()),
      rho_(0.5 * length(box.size())),
      relative_error_(relative_error),
      share_(share) {
  const Kernel kernel{blend.kernel, blend.degree, blend.kernel_shape};
  const bool is_cauchy = blend.kernel == KernelFamily::Cauchy;
  if (is_cauchy) per_lift_ = 1 / blend.kernel_shape;
  for (int dimension = 0; dimension < 3; ++dimension) {
    const Profile profile(kernel, dimension);
    const double shape = is_cauchy ? integer_power(per_lift_, profile.degree()) : 1;
    unit_[dimension] = shape / profile.normalisation();
  }
}

// From anywhere in the box.
SourceMaker::Weak SourceMaker::seen(double distance, double least_radius) const {
  const double clear = distance - rho_, lift = per_lift_ * least_radius;
  // Under the Cauchy kernel a skeleton is never nearer than its lift.
  const double lifted = std::sqrt(std::max(0.0, clear) * std::max(0.0, clear) + lift * lift);
  return {clear, lifted, lifted < nearest * rho_};
}

double SourceMaker::allowed(double mass, double radius, double distance, int m) const {
  const double field = mass * integer_power(radius, degree_ - 1) / integer_power(distance, m);
  return relative_error_ * std::max(1.0, share_ / field);
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
           .lift_squared = lift * lift});
}

void SourceMaker::add(const PointSkeleton& s) {
  if (seen(distance_to(s, center_), s.radius).too_near) rest_points.skeletons.push_back(s);
  else emit(points, s.at, 1, s.radius, 0);
}

bool SourceMaker::add_part(const SegmentSkeleton& s) {
  const double size = length(s.to - s.from), radius = largest_radius(s), half = 0.5 * (radius - least_radius(s));
  const double distance = seen(distance_to(s, center_), least_radius(s)).lifted, mass = unit_[1] * size;
  const int m = curves.exponent();
  const double relative = allowed(mass, radius, distance, m);
  const auto nodes = rule_nodes({.half_length = 0.5 * size,
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
    emit(curves, lerp(s.from, s.to, t), size * rule.weights[k], s.radius_from + (s.radius_to - s.radius_from) * t, 1);
  }
  note(mass, radius, distance, m, relative);
  return true;
}

bool SourceMaker::add_part(const ArcSkeleton& s) {
  const double angle = s.end - s.begin, size = s.major * angle, radius = largest_radius(s);
  const double half = 0.5 * (radius - least_radius(s)), mass = unit_[1] * size;
  const double distance = seen(least_distance(s, center_), least_radius(s)).lifted;
  const int m = curves.exponent();
  if (!(distance > 0)) return false;
  const double relative = allowed(mass, radius, distance, m);
  const auto nodes = rule_nodes({.half_length = 0.5 * size,
                                 .half_angle = 0.5 * angle,
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
    emit(curves, place(s, s.begin + angle * t), size * rule.weights[k],
         s.radius_from + (s.radius_to - s.radius_from) * t, 1);
  }
  note(mass, radius, distance, m, relative);
  return true;
}

// Lines from one corner to the opposite side: at a + u (b - a) + u v (c - b) the measure is 2 area u du dv. Each of the
// two rules may err by half.
bool SourceMaker::add_part(const TriangleSkeleton& s) {
  const auto& [a, b, c] = s.vertices;
  const double radius = largest_radius(s), half = 0.5 * (radius - least_radius(s)), mass = unit_[2] * area(s);
  const double distance = seen(least_distance(s, center_), least_radius(s)).lifted;
  const int m = surfaces.exponent();
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
      emit(surfaces, a + (b - a) * u + (c - b) * uv, 2 * area(s) * u * us.weights[i] * vs.weights[k],
           s.radii[0] + (s.radii[1] - s.radii[0]) * u + (s.radii[2] - s.radii[1]) * uv, 2);
    }
  note(mass, radius, distance, m, relative);
  return true;
}

void SourceMaker::add(const SegmentSkeleton& s) {
  if (seen(distance_to(s, center_), least_radius(s)).too_near || !(length(s.to - s.from) > 0)) {
    rest_segments.skeletons.push_back(s);
    return;
  }
  divided(
      s, [&](const SegmentSkeleton& part) { return add_part(part); },
      [&](const SegmentSkeleton& part) { rest_segments.skeletons.push_back(part); });
}

// A part of an arc may be far where its circle is near.
void SourceMaker::add(const ArcSkeleton& s) {
  const double half = 0.5 * s.major * (s.end - s.begin);
  const Weak all = seen(least_distance(s, center_), least_radius(s));
  if (all.too_near && half < 2 * rho_) {
    rest_arcs.skeletons.push_back(s);
    return;
  }
  if (!all.too_near && add_part(s)) return;
  if (s.end - s.begin < 1e-3) {
    rest_arcs.skeletons.push_back(s);
    return;
  }
  for (const ArcSkeleton& part : parts(s)) add(part);
}

void SourceMaker::add(const TriangleSkeleton& s) {
  if (seen(least_distance(s, center_), least_radius(s)).too_near || !(area(s) > 0)) {
    rest_triangles.skeletons.push_back(s);
    return;
  }
  divided(
      s, [&](const TriangleSkeleton& part) { return add_part(part); },
      [&](const TriangleSkeleton& part) { rest_triangles.skeletons.push_back(part); });
}

}  // namespace marrow
