#include "field/trace/angle_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <optional>

#include <tbb/parallel_for.h>

#include "field/blend/correction.h"
#include "field/trace/turned_curve.h"

namespace marrow {
namespace {

// Of angles.
constexpr double largest_step = 0.02;
constexpr int fewest_steps = 8, fewest_entries = 512;
// Where G is nearly 0 curves of small angles run along the axis of G, see iso_table.cpp.
constexpr double least_turn = 0.3;
// To the kink at the border of the cavity branch, so that an entry stands there for all angles of a step.
constexpr double fewest_entries_to_kink = 8;
// The end of a curve counts up to so many times the gradient of the reference curve at the iso-value. Curves of angles
// near pi/2 end far beyond, and move fast.
constexpr double farthest_end = 3;
// Of float entries and of what is reckoned from them in float, relative.
constexpr double rounding = 6e-7;

// A quadratic by its values at -1/2, 0 and 1/2, rounded to float.
struct Quadratic {
  std::array<float, 3> p{};

  Quadratic() = default;
  Quadratic(double a, double b, double c)
      : p{static_cast<float>(b), static_cast<float>(c - a), static_cast<float>(2 * (a - 2 * b + c))} {}
  double at(double s) const {
    return static_cast<double>(p[0]) + s * (static_cast<double>(p[1]) + s * static_cast<double>(p[2]));
  }
};

struct Curve {
  Correction correction;
  TurnedCurve turned;
  Curve(const Correction& like, double alpha, double turn)
      : correction(like.degree(), alpha, like.cavity(), like.projection()),
        turned(correction, critical_field_of(correction), turn) {}
  Curve(const Curve&) = delete;
  Curve& operator=(const Curve&) = delete;

  // V', from the partials: along the curve C_x dx + C_y dy = 0.
  std::optional<double> slope(double u, double v) const {
    const TurnedLine line = turned.line_of(u);
    const auto c = correction.partials(line.x(v), line.y(v));
    const double slope =
        (turned.cosine() * c.df - turned.sine() * c.dG) / (turned.sine() * c.df + turned.cosine() * c.dG);
    return std::isfinite(slope) ? std::optional(slope) : std::nullopt;
  }
};

// One step of the range.
class Step {
 public:
  Quadratic begin, inverse_step;
  double sine = 0, cosine = 0;
  std::vector<Quadratic> value, slope;
  std::vector<double> below;

  Step(const Correction& like, double middle, double width) {
    const double turn = std::max(middle, least_turn);
    const Curve curves[3] = {{like, middle - width / 2, turn}, {like, middle, turn}, {like, middle + width / 2, turn}};
    sine = curves[1].turned.sine();
    cosine = curves[1].turned.cosine();
    find_places(curves);
    find_values(curves);
    below.assign(value.size(), 0);
    probe(curves[1], 0, {0.25, 0.5, 0.75});
    for (const double s : {-0.25, 0.25}) probe(Curve(like, middle + s * width, turn), s, {0, 0.5});
  }

 private:
  double place(double entry, double s) const { return begin.at(s) + entry / inverse_step.at(s); }

  // As long for all three curves; or so that they all end at the same entry, where they end at the axis x = 0; or so
  // that the same entry stands at the kink of each, where they have one.
  void find_places(const Curve (&curves)[3]) {
    double lengths[3], kinks[3];
    bool have_kinks = true, have_ends = true;
    for (int k = 0; k < 3; ++k) {
      const TurnedCurve& c = curves[k].turned;
      lengths[k] = (c.end() - c.begin()) / (fewest_entries - 1);
      const auto kink = c.kink();
      kinks[k] = kink.value_or(c.begin()) - c.begin();
      have_kinks = have_kinks && kink;
      have_ends = have_ends && c.ends_at_axis() && c.end() < farthest_end * (curves[k].correction.degree() - 1);
    }
    const double longest = std::max({lengths[0], lengths[1], lengths[2]}), before = std::ceil(kinks[1] / lengths[1]);
    const bool to_kinks = have_kinks && before >= fewest_entries_to_kink;
    for (int k = 0; k < 3; ++k) {
      if (to_kinks) lengths[k] = kinks[k] / before;
      else if (!have_ends) lengths[k] = longest;
    }
    begin = {curves[0].turned.begin(), curves[1].turned.begin(), curves[2].turned.begin()};
    inverse_step = {1 / lengths[0], 1 / lengths[1], 1 / lengths[2]};
    double entries = 0;
    for (int k = 0; k < 3; ++k) {
      const TurnedCurve& c = curves[k].turned;
      entries = std::max(entries, (c.end() - c.begin()) / lengths[k]);
    }
    value.resize(static_cast<std::size_t>(std::ceil(entries)) + 1);
  }

  void find_values(const Curve (&curves)[3]) {
    std::vector<double> found[3], slopes[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const double s = 0.5 * (static_cast<double>(k) - 1);
      for (std::size_t i = 0; i < value.size(); ++i) {
        const double u = place(static_cast<double>(i), s);
        // By the parabola through the last three.
        std::vector<double>& v = found[k];
        const bool known = i > 3;
        const double guess = known ? 3 * (v[i - 1] - v[i - 2]) + v[i - 3] : 0;
        v.push_back(curves[k].turned.value(u, guess, known ? 1e-4 / inverse_step.at(s) : 0));
        const double before = i > 0 ? (v[i] - v[i - 1]) * inverse_step.at(s) : 0;
        slopes[k].push_back(curves[k].slope(u, v[i]).value_or(before));
      }
    }
    for (std::size_t i = 0; i < value.size(); ++i) {
      value[i] = {found[0][i], found[1][i], found[2][i]};
      slope.emplace_back(slopes[0][i], slopes[1][i], slopes[2][i]);
    }
  }

  // How far below V a curve is, where `places` are from each entry to the next. What quadratics and straight lines are
  // off are smooth arches, but for kinks: at most twice as much as there.
  void probe(const Curve& curve, double s, std::initializer_list<double> places) {
    double known = 1e-6;
    for (std::size_t i = 0; i + 1 < value.size(); ++i) {
      double low = 0, largest = 0;
      for (const double fraction : places) {
        const double from = value[i].at(s);
        const double line = from + (value[i + 1].at(s) - from) * fraction;
        const double error = line - curve.turned.value(place(static_cast<double>(i) + fraction, s), line, known);
        low = std::max(low, 2 * error);
        largest = std::max(largest, std::fabs(error));
      }
      known = 4 * largest + 1e-9;
      for (const std::size_t j : {i, i + 1}) below[j] = std::max(below[j], low);
    }
  }
};

void add(const Quadratic& q, double last, std::vector<float>& to) {
  to.insert(to.end(), q.p.begin(), q.p.end());
  to.push_back(static_cast<float>(last));
}

}  // namespace

AngleCurves::AngleCurves(const Correction& correction, double least, double most) {
  const double steps = std::max<double>(fewest_steps, std::ceil((most - least) / largest_step));
  const double width = (most - least) / steps;
  count_ = static_cast<int>(steps);
  std::vector<std::optional<Step>> made(static_cast<std::size_t>(count_));
  tbb::parallel_for(std::size_t{0}, made.size(), [&](std::size_t k) {
    made[k].emplace(correction, least + (static_cast<double>(k) + 0.5) * width, width);
  });
  std::size_t stride = 0;
  for (const auto& step : made) stride = std::max(stride, step->value.size());
  stride_ = static_cast<int>(stride);
  for (std::size_t k = 0; k < made.size(); ++k) {
    const Step& step = *made[k];
    for (std::size_t i = 0; i < step.value.size(); ++i) {
      const double highest = std::fabs(step.value[i].at(-0.5)) + std::fabs(step.value[i].at(0.5));
      add(step.value[i], step.below[i] + rounding * (1 + highest), entries_);
      add(step.slope[i], 0, slopes_);
    }
    entries_.resize(4 * stride * (k + 1));
    slopes_.resize(4 * stride * (k + 1));
    for (std::size_t i = 0; i < 3; ++i) {
      of_steps_[i].push_back(step.begin.p[i]);
      of_steps_[3 + i].push_back(step.inverse_step.p[i]);
    }
    of_steps_[6].push_back(static_cast<float>(step.sine));
    of_steps_[7].push_back(static_cast<float>(step.cosine));
    of_steps_[8].push_back(static_cast<float>(step.value.size() - 1));
  }
  constexpr std::size_t numbers = 32;
  for (auto& of_all : of_steps_) of_all.resize(std::max(of_all.size(), numbers));
}

AngleTables AngleCurves::tables() const {
  if (entries_.empty()) return {};
  const auto of = [&](int i) { return of_steps_[i].data(); };
  return {.entries = entries_.data(),
          .slopes = slopes_.data(),
          .begin = {of(0), of(1), of(2)},
          .inverse_step = {of(3), of(4), of(5)},
          .sin_theta = of(6),
          .cos_theta = of(7),
          .last = of(8),
          .stride = stride_,
          .count = count_};
}

}  // namespace marrow
