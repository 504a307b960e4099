#include "field/trace/curve/angle_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <optional>

#include <tbb/parallel_for.h>

#include "field/blend/correction/correction.h"
#include "field/trace/curve/turned_curve.h"

namespace marrow {
namespace {

// Of angles.
constexpr double largest_step = 0.02;
constexpr int fewest_steps = 8, fewest_entries = 512;
// Curves end near by when it is at no more times the gradient of the reference curve at the iso-value than this.
constexpr double farthest_end = 2;
// Before the kink at the border of the cavity branch.
constexpr double fewest_entries_to_kink = 4;
// Where a curve may begin between entries, or have a kink there.
constexpr std::size_t first_entries = 8;
// Of float entries and of what is reckoned from them in float, relative.
constexpr double rounding = 6e-7;
// Towards the axis f = 0 curves are as steep as roots, and those of some angles of a step have ended: nothing is
// certain from this f on. No field has so large a gradient there.
constexpr double least_certain_field = 0.1;
// Below V by so much no place is outside.
constexpr double uncertain = 1e4;

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
  Curve(const Correction& like, double alpha, double turn, UpToGradient up_to)
      : correction(like.degree(), alpha, like.cavity(), like.projection()),
        turned(correction, critical_field_of(correction), turn, up_to) {}
  Curve(const Curve&) = delete;
  Curve& operator=(const Curve&) = delete;
};

// One step of the range.
class Step {
 public:
  Quadratic begin, inverse_step;
  double sine = 0, cosine = 0;
  std::vector<Quadratic> value, slope;
  std::vector<double> below, growth;  // growth: dC/dv at least; 0 where it is not known
  double crest_from = 0, crest_to = 0, rise = 0;

  Step(const Correction& like, double middle, double width, UpToGradient up_to) {
    const double turn = turn_for(middle - 0.5 * width, middle);
    const auto at = [&](double s) { return Curve(like, middle + s * width, turn, up_to); };
    const Curve curves[3] = {at(-0.5), at(0), at(0.5)};
    sine = curves[1].turned.sine();
    cosine = curves[1].turned.cosine();
    find_places(curves);
    find_values(curves);
    below.assign(value.size(), 0);
    probe(curves[1], 0, {0.25, 0.5, 0.75});
    for (const double s : {-0.25, 0.25}) probe(at(s), s, {0, 0.5});
    for (const double s : {-0.45, -0.35, -0.15, -0.05, 0.05, 0.15, 0.35, 0.45})
      probe(at(s), s, {0, 0.25, 0.5, 0.75}, first_entries);
    for (std::size_t k = 0; k < 3; ++k) leave_end_uncertain(curves[k].turned, 0.5 * (static_cast<double>(k) - 1));
    if (middle - 0.5 * width < 0) find_crest(curves);
  }

 private:
  double place(double entry, double s) const { return begin.at(s) + entry / inverse_step.at(s); }

  // Equal steps for all angles, from a begin that moves with the angle: so that the same entry stands at the kink of
  // each curve, or else at the begin of each. Without kinks, curves that end near by end at the same entry, too: else,
  // where begins move fast, far steps would with them. Where ends move fast themselves it would make quadratics in the
  // angle ten times as rough.
  void find_places(const Curve (&curves)[3]) {
    double lengths[3];
    bool ends_near = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const TurnedCurve& c = curves[k].turned;
      const double times = std::max(1.0, std::ceil(c.end() / usual_gradient(curves[k].correction)));
      lengths[k] = (c.end() - c.begin()) / (times * fewest_entries - 1);
      ends_near = ends_near && c.ends_at_axis() && c.end() < farthest_end * (curves[k].correction.degree() - 1);
    }
    const double longest = std::max({lengths[0], lengths[1], lengths[2]});
    const auto kinks = kinks_of(curves, fewest_entries_to_kink * longest);
    const bool at_kinks = kinks.has_value();
    const std::array<double, 3> fixed =
        kinks.value_or(std::array{curves[0].turned.begin(), curves[1].turned.begin(), curves[2].turned.begin()});
    double before = 0, behind = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const TurnedCurve& c = curves[k].turned;
      if (at_kinks || !ends_near) lengths[k] = longest;
      before = std::max(before, std::ceil((fixed[k] - c.begin()) / lengths[k]));
      behind = std::max(behind, std::ceil((c.end() - fixed[k]) / lengths[k]));
    }
    inverse_step = {1 / lengths[0], 1 / lengths[1], 1 / lengths[2]};
    begin = {fixed[0] - before * lengths[0], fixed[1] - before * lengths[1], fixed[2] - before * lengths[2]};
    value.resize(static_cast<std::size_t>(before + behind) + 1);
  }

  // Where all curves have one that is not nearer to the begin than this: from there they move too fast.
  static std::optional<std::array<double, 3>> kinks_of(const Curve (&curves)[3], double from_begin) {
    std::array<double, 3> kinks{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto kink = curves[k].turned.kink();
      if (!kink || *kink - curves[k].turned.begin() < from_begin) return {};
      kinks[k] = *kink;
    }
    return kinks;
  }

  void find_values(const Curve (&curves)[3]) {
    std::vector<TurnedCurve::Place> places[3];
    for (std::size_t k = 0; k < 3; ++k) places[k] = places_on(curves[k].turned, 0.5 * (static_cast<double>(k) - 1));
    for (std::size_t i = 0; i < value.size(); ++i) {
      const TurnedCurve::Place &a = places[0][i], &b = places[1][i], &c = places[2][i];
      value[i] = {a.v, b.v, c.v};
      slope.emplace_back(a.slope, b.slope, c.slope);
      growth.push_back(std::min({a.growth, b.growth, c.growth}));
    }
  }

  // One for each entry: before the curve begins, where no place is, and behind its end along its tangent, with no
  // growth.
  std::vector<TurnedCurve::Place> places_on(const TurnedCurve& curve, double s) const {
    const double first = curve.begin(), length = 1 / inverse_step.at(s);
    TurnedCurve::Place at_begin = curve.place(first, curve.value(first));
    if (!std::isfinite(at_begin.slope)) at_begin.slope = 0;
    std::vector<TurnedCurve::Place> places;
    int known = 0;
    for (std::size_t i = 0; i < value.size(); ++i) {
      const double u = place(static_cast<double>(i), s);
      if (u < first) {
        places.push_back({at_begin.v + at_begin.slope * (u - first), at_begin.slope, 0});
      } else if (u > curve.end() && curve.ends_at_axis()) {
        places.push_back({places[i - 1].v + places[i - 1].slope * length, places[i - 1].slope, 0});
      } else {
        const bool guessed = ++known > 2;
        places.push_back(curve.place(u, guessed ? value_behind(places[i - 2], places[i - 1], length) : curve.value(u)));
        TurnedCurve::Place& last = places.back();
        if (!std::isfinite(last.slope)) last.slope = i > 0 ? (last.v - places[i - 1].v) / length : 0;
      }
    }
    return places;
  }

  // By the entries, one more on both sides, and as far again as the crests of the three curves are apart; the slopes of
  // the entries behind, and a tenth more for those between them.
  void find_crest(const Curve (&curves)[3]) {
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double s = 0.5 * (static_cast<double>(k) - 1);
      const auto line_of = [&](std::size_t i) { return curves[k].turned.line_of(place(static_cast<double>(i), s)); };
      const auto x = [&](std::size_t i) { return line_of(i).x(value[i].at(s)); };
      const auto y = [&](std::size_t i) { return line_of(i).y(value[i].at(s)); };
      std::size_t crest = 0;
      for (std::size_t i = 1; i + 1 < value.size() && x(i) > least_certain_field; ++i)
        if (y(i) > y(crest)) crest = i;
      least = std::min(least, x(crest + 1));
      most = std::max(most, x(crest > 0 ? crest - 1 : 0));
      for (std::size_t i = crest + 1; i < value.size() && x(i) > least_certain_field; ++i) {
        const double dv = slope[i].at(s);
        rise = std::max(rise, 1.1 * (sine + dv * cosine) / (dv * sine - cosine));
      }
    }
    crest_from = std::max(0.0, 2 * least - most);
    crest_to = 2 * most - least;
  }

  // Curves fall in f towards their end, and those of other angles lie between them.
  void leave_end_uncertain(const TurnedCurve& curve, double s) {
    for (std::size_t i = value.size(); i-- > 0;) {
      const double field = curve.line_of(place(static_cast<double>(i), s)).x(value[i].at(s));
      if (field > least_certain_field) return;
      below[i] = uncertain;
    }
  }

  // How far below V a curve is, where `places` are from each entry to the next, or where it begins if it does so
  // between them. What quadratics and straight lines are off are smooth arches, but for kinks: at most twice as much as
  // there.
  void probe(const Curve& curve, double s, std::initializer_list<double> places,
             std::size_t most = std::numeric_limits<std::size_t>::max()) {
    for (std::size_t i = 0; i + 1 < std::min(value.size(), most); ++i) {
      const double from = place(static_cast<double>(i), s),
                   begin_at = (curve.turned.begin() - from) * inverse_step.at(s);
      if (begin_at > 1) continue;
      double low = 0;
      for (const double at : places) {
        const double fraction = std::max(at, begin_at), line = std::lerp(value[i].at(s), value[i + 1].at(s), fraction);
        const double u = from + fraction / inverse_step.at(s);
        low = std::max(low, 2 * curve.turned.height(u, line, {growth[i], growth[i + 1]}));
      }
      for (const std::size_t j : {i, i + 1}) below[j] = std::max(below[j], low);
    }
  }
};

void add(const Quadratic& q, double last, std::vector<float>& to) {
  to.insert(to.end(), q.p.begin(), q.p.end());
  to.push_back(static_cast<float>(last));
}

}  // namespace

AngleCurves::AngleCurves(const Correction& correction, double least, double most, UpToGradient up_to) {
  const double steps = std::max<double>(fewest_steps, std::ceil((most - least) / largest_step));
  const double width = (most - least) / steps;
  count_ = static_cast<int>(steps);
  std::vector<std::optional<Step>> made(static_cast<std::size_t>(count_));
  tbb::parallel_for(std::size_t{0}, made.size(), [&](std::size_t k) {
    made[k].emplace(correction, least + (static_cast<double>(k) + 0.5) * width, width, up_to);
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
    of_steps_[9].push_back(static_cast<float>(step.crest_from));
    of_steps_[10].push_back(static_cast<float>(step.crest_to));
    of_steps_[11].push_back(static_cast<float>(step.rise));
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
          .crest_from = of(9),
          .crest_to = of(10),
          .rise = of(11),
          .stride = stride_,
          .count = count_};
}

}  // namespace marrow
