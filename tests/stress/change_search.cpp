// Where a field along a ray changes sides, by samples of its exact values.
#include "tests/stress/change_search.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "field/program/field_program.h"

namespace marrow::test {
namespace {

// Fields this near to 1 are neither in nor out.
constexpr double flat = 1e-7;
// Between two samples whose sides are the same.
constexpr int most_halvings = 10;

std::vector<double> knots_of(double begin, double end, std::span<const double> places) {
  constexpr int even = 80;
  const double way = end - begin;
  std::vector<double> knots;
  for (int i = 0; i <= even; ++i) knots.push_back(begin + way * i / even);
  for (const double place : places)
    for (double step = way / 64; step > 1e-10 * way; step /= 4)
      for (const double t : {place - step, place, place + step})
        if (t > begin && t < end) knots.push_back(t);
  std::sort(knots.begin(), knots.end());
  knots.erase(std::unique(knots.begin(), knots.end()), knots.end());
  return knots;
}

}  // namespace

ChangeSearch::Sample ChangeSearch::at(double t) {
  ++samples_;
  const FieldSample f = value_and_gradient(tree_, ray_.at(t));
  const double off = f.value - 1, scale = 1 + std::fabs(off);
  if (!std::isfinite(off)) return {t, off > 0 ? 1.0 : -1.0, 0};
  const double slope = dot(f.gradient, ray_.direction.vec());
  return {t, off / scale, std::isfinite(slope) ? slope / (scale * scale) : 0};
}

// The cubic stays off 0 by several times what it is off in the middle.
bool ChangeSearch::is_clear(const Sample& a, const Sample& middle, const Sample& b) {
  if (std::max({std::fabs(a.u), std::fabs(middle.u), std::fabs(b.u)}) < flat) return true;
  const double way = b.t - a.t, side = a.is_inside() ? 1 : -1;
  const auto cubic = [&](double x) {
    const double y = 1 - x;
    return a.u * y * y * (1 + 2 * x) + b.u * x * x * (1 + 2 * y) + way * x * y * (a.slope * y - b.slope * x);
  };
  double nearest = side * middle.u;
  for (int i = 1; i < 8; ++i) nearest = std::min(nearest, side * cubic(i / 8.0));
  return nearest > 4 * std::fabs(middle.u - cubic(0.5));
}

std::optional<double> ChangeSearch::between(const Sample& a, const Sample& b, int halvings) {
  const bool changes = a.is_inside() != b.is_inside();
  const double middle_t = a.t + 0.5 * (b.t - a.t);
  if (!(a.t < middle_t && middle_t < b.t)) return changes ? std::optional(b.t) : std::nullopt;
  if (gave_up() || (!changes && halvings >= most_halvings)) return changes ? std::optional(b.t) : std::nullopt;
  const Sample middle = at(middle_t);
  if (!changes && middle.is_inside() == a.is_inside() && is_clear(a, middle, b)) return {};
  if (const auto left = between(a, middle, halvings + 1)) return left;
  return between(middle, b, halvings + 1);
}

std::optional<double> ChangeSearch::first(double begin, double end, std::span<const double> places) {
  if (!(begin < end)) return {};
  samples_ = 0;
  const std::vector<double> knots = knots_of(begin, end, places);
  Sample before = at(knots.front());
  for (std::size_t i = 1; i < knots.size() && !gave_up(); ++i) {
    const Sample here = at(knots[i]);
    if (const auto t = between(before, here, 0)) return t;
    before = here;
  }
  return {};
}

double ChangeSearch::depth(double t0, double t1) const {
  const bool inside = is_inside(t0);
  double most = 0, change = t1;
  const auto look = [&](double t) {
    if (t >= change) return;
    const double f = value(t);
    if ((f >= 1) != inside) change = t;
    else most = std::max(most, std::fabs(f - 1));
  };
  for (double step = 1e-12 * (t1 - t0); step <= t1 - t0; step *= 2) look(t0 + step);
  constexpr int even = 64;
  const double end = change;
  for (int i = 1; i < even; ++i) look(t0 + (end - t0) * i / even);
  return most;
}

}  // namespace marrow::test
