#include "field/trace/sources/rule_errors.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "field/kernel/inverse_family.h"
#include "field/math/elementary.h"
#include "field/math/gauss_rule.h"
#include "field/trace/sources/quadrature.h"

namespace marrow {
namespace {

constexpr int beside = 96, about_end = 32, places = beside + about_end;

// The border at one distance from the piece, by symmetry from its middle on: along it, closer towards its end, and
// about the end.
struct Border {
  std::array<double, places> along, across2;

  explicit Border(double distance) {
    for (int i = 0; i < beside; ++i) {
      const double u = 1 - static_cast<double>(i) / beside;
      along[static_cast<std::size_t>(i)] = 1 - u * u;
      across2[static_cast<std::size_t>(i)] = distance * distance;
    }
    for (int i = 0; i < about_end; ++i) {
      const double u = static_cast<double>(i) / (about_end - 1), scale = distance / (1 + u * u);
      along[static_cast<std::size_t>(beside + i)] = 1 + 2 * u * scale;
      across2[static_cast<std::size_t>(beside + i)] = (1 - u * u) * (1 - u * u) * scale * scale;
    }
  }
};

// Sums over nodes at all places of a border, for the weight s^j: the field, and the two components of the vector.
struct Sums {
  std::array<double, places> field{}, along{}, across{};  // across: over the distance from the axis
};

using SumsOfPowers = std::vector<Sums>;  // [j]

void add_node(const Border& border, int degree, double s, double weight, SumsOfPowers& sums) {
  std::array<double, places> field;
  for (std::size_t i = 0; i < places; ++i) {
    const double a = border.along[i] - s, d2 = a * a + border.across2[i];
    const double power = integer_power(d2, degree / 2);
    field[i] = weight / (degree % 2 ? power * std::sqrt(d2) : power);
  }
  double raised = 1;  // s^j
  for (Sums& sum : sums) {
    for (std::size_t i = 0; i < places; ++i) {
      const double a = border.along[i] - s, f = raised * field[i];
      const double g = degree * f / (a * a + border.across2[i]);
      sum.field[i] += f;
      sum.along[i] += g * a;
      sum.across[i] += g;
    }
    raised *= s;
  }
}

SumsOfPowers by_rule(const Border& border, int degree, int nodes, std::size_t powers) {
  SumsOfPowers sums(powers);
  const GaussNodes rule = gauss_legendre(nodes);
  for (std::size_t k = 0; k < rule.positions.size(); ++k)
    add_node(border, degree, 2 * rule.positions[k] - 1, rule.weights[k], sums);
  return sums;
}

// Panels no longer than twice the distance: rules of 24 nodes are then off by 1e-14 of the integral.
SumsOfPowers by_panels(const Border& border, int degree, double distance, std::size_t powers) {
  SumsOfPowers sums(powers);
  const auto& rule = gauss_rule<24>;
  const int panels = static_cast<int>(std::ceil(1 / distance));
  for (int panel = 0; panel < panels; ++panel)
    for (std::size_t k = 0; k < rule.nodes.size(); ++k)
      add_node(border, degree, 2 * (panel + rule.nodes[k]) / panels - 1, rule.weights[k] / panels, sums);
  return sums;
}

// Of powers beyond the first the last is the vector's alone.
RuleErrors::Error largest(const Border& border, int degree, double distance, const SumsOfPowers& exact,
                          const SumsOfPowers& rule) {
  RuleErrors::Error e;
  for (std::size_t j = 0; j < exact.size(); ++j) {
    double field = 0, gradient2 = 0;
    for (std::size_t i = 0; i < places; ++i) {
      field = std::max(field, std::fabs(exact[j].field[i] - rule[j].field[i]));
      const double along = exact[j].along[i] - rule[j].along[i], across = exact[j].across[i] - rule[j].across[i];
      gradient2 = std::max(gradient2, along * along + across * across * border.across2[i]);
    }
    if (j == 0 || j + 1 < exact.size()) e.field = std::max(e.field, field);
    e.gradient = std::max(e.gradient, std::sqrt(gradient2));
  }
  constexpr double between_places = 1.1, rounding = 1e-13;
  const double field = 1 / std::sqrt(integer_power(distance * distance, degree));
  return {.field = between_places * e.field + rounding * field,
          .gradient = between_places * e.gradient + rounding * degree * field / distance};
}

std::size_t powers_of(RuleErrors::Weight weight, int degree) {
  const auto n = static_cast<std::size_t>(degree);
  return weight == RuleErrors::Weight::Constant ? 1 : weight == RuleErrors::Weight::Tapered ? n + 1 : n + 2;
}

// With w = ((1 + k s) / (1 + |k|))^(n-1) the weights binom(n-1, j) k^j / (1 + |k|)^(n-1) of the powers s^j have
// absolute values that add up to 1, so that the largest error of a power bounds them all; so they have with one more
// such factor.
RuleErrors::Row make_row(int degree, double distance, RuleErrors::Weight weight) {
  const std::size_t powers = powers_of(weight, degree);
  const Border border(distance);
  const SumsOfPowers exact = by_panels(border, degree, distance, powers);
  RuleErrors::Row row{};
  for (int nodes = 1; nodes <= RuleErrors::most_nodes; ++nodes)
    row[static_cast<std::size_t>(nodes)] =
        largest(border, degree, distance, exact, by_rule(border, degree, nodes, powers));
  return row;
}

}  // namespace

const RuleErrors& RuleErrors::of(int degree) {
  static const std::array<Lazy<RuleErrors>, max_kernel_degree + 1> all;
  return all[static_cast<std::size_t>(degree)].get(
      [degree] { return std::unique_ptr<const RuleErrors>(new RuleErrors(degree)); });
}

const RuleErrors::Row& RuleErrors::row(double distance, Weight weight) const {
  // distance = 2^exponent fraction, 1/2 <= fraction < 1: `steps` equal steps of the fraction.
  int exponent;
  const double fraction = std::frexp(distance, &exponent);
  const int step = static_cast<int>((fraction - 0.5) * 2 * steps);
  const double lower = std::ldexp(0.5 + 0.5 * step / steps, exponent);
  const int octave = exponent - least_exponent;
  return rows_[static_cast<std::size_t>(weight)][static_cast<std::size_t>(octave * steps + step)].get(
      [&] { return std::make_unique<const Row>(make_row(degree_, lower, weight)); });
}

}  // namespace marrow
