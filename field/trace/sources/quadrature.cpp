#include "field/trace/sources/quadrature.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "field/math/elementary.h"
#include "field/math/gauss_rule.h"

namespace marrow {
namespace {

template <std::size_t... Counts>
constexpr std::array<GaussNodes, sizeof...(Counts)> all_rules(std::index_sequence<Counts...>) {
  return {GaussNodes{gauss_rule<Counts + 1>.nodes, gauss_rule<Counts + 1>.weights}...};
}

double binomial(int n, int k) {
  double b = 1;
  for (int i = 1; i <= k; ++i) b *= static_cast<double>(n - k + i) / i;
  return b;
}

}  // namespace

GaussNodes gauss_legendre(int count) {
  static constexpr auto rules = all_rules(std::make_index_sequence<max_gauss_nodes>());
  return rules[static_cast<std::size_t>(count - 1)];
}

const NodeTable& node_table() {
  static const NodeTable table = [] {
    NodeTable t{};
    for (int count = 1; count <= max_gauss_nodes; ++count) {
      const GaussNodes rule = gauss_legendre(count);
      for (std::size_t i = 0; i < rule.positions.size(); ++i)
        for (const std::size_t copy : {i, i + lanes}) {
          t.positions[count][copy] = static_cast<float>(rule.positions[i]);
          t.weights[count][copy] = static_cast<float>(rule.weights[i]);
        }
    }
    return t;
  }();
  return table;
}

GaussError::GaussError(int degree) : degree_(degree), close_(&RuleErrors::of(degree)) {
  // c_m = (m!)^4 / ((2m+1) ((2m)!)^2) = 1 / ((2m+1) binom(2m, m)^2)
  for (int m = 1; m <= max_gauss_nodes; ++m) {
    const double central = binomial(2 * m, m);
    const double c = 1 / ((2 * m + 1) * central * central);
    field_[static_cast<std::size_t>(m)] = c * binomial(degree + 2 * m - 1, 2 * m);
    gradient_[static_cast<std::size_t>(m)] = c * degree * binomial(degree + 2 * m, 2 * m);
  }
}

namespace {

using Bound = GaussError::Bound;

Bound least(const Bound& a, const Bound& b) { return {std::min(a.field, b.field), std::min(a.gradient, b.gradient)}; }

}  // namespace

// What holds of one piece at one distance, for rules of 1, 2, 3, ... nodes in turn.
class GaussError::Rules {
 public:
  Rules(const GaussError& of, const Stretch& s, double distance) : of_(of) {
    const double ratio = s.length / distance, taper = 1 + s.slope * distance / s.largest_radius;
    shrink_ = ratio * ratio;
    series_.field = s.mass * integer_power(taper, of.degree_ - 1) / integer_power(distance, of.degree_);
    series_.field *= 1 + std::fabs(s.lean) * distance / s.length;
    series_.gradient = series_.field * taper * s.largest_radius / distance;
    const double half = 0.5 * s.length, halves = distance / half;
    if (halves < RuleErrors::least_distance || halves >= RuleErrors::end_of_distances) return;
    row_ = &of.close_->row(halves, s.lean != 0    ? RuleErrors::Weight::Leaning
                                   : s.slope != 0 ? RuleErrors::Weight::Tapered
                                                  : RuleErrors::Weight::Constant);
    unit_.field = s.mass / integer_power(half, of.degree_);
    unit_.gradient = unit_.field * s.largest_radius / half;
  }

  /// To be asked for 1, 2, 3, ... nodes.
  Bound next() {
    ++nodes_;
    series_.field *= shrink_;
    series_.gradient *= shrink_;
    const Bound by_series{of_.field_[nodes_] * series_.field, of_.gradient_[nodes_] * series_.gradient};
    if (row_ == nullptr) return by_series;
    const RuleErrors::Error& e = (*row_)[nodes_];
    return least(by_series, {e.field * unit_.field, e.gradient * unit_.gradient});
  }

 private:
  const GaussError& of_;
  std::size_t nodes_ = 0;
  double shrink_ = 0;
  Bound series_{}, unit_{};
  const RuleErrors::Row* row_ = nullptr;
};

GaussError::Bound GaussError::bound(int nodes, const Stretch& stretch, double distance) const {
  Rules rules(*this, stretch, distance);
  Bound b{};
  for (int m = 1; m <= nodes; ++m) b = rules.next();
  return b;
}

GaussError::Rule GaussError::smallest_rule(const Stretch& stretch, double distance, Bound allowed) const {
  Rules rules(*this, stretch, distance);
  for (int m = 1;; ++m) {
    const Bound b = rules.next();
    const bool within = b.field <= allowed.field && b.gradient <= allowed.gradient;
    if (within || m == max_gauss_nodes) return {m, b, within};
  }
}

}  // namespace marrow
