// De Groot's better blending: fields are narrowed before they are added, so that small parts still blend with large
// ones.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "field/number/functions.h"
#include "field/tree/node_info.h"

namespace marrow {

/// g_k(t) for k = 1 - width: 0 up to k, 1 at 1, 2 from 2 - k on, C1. With s = (1 - t) / width, cut to [-1, 1], it is
/// (1 - s)^2, and point-symmetric about (1, 1).   [de Groot 2003, sec. 3.3, with c = 1]
template <Number X>
X narrowed(const X& t, const X& width) {
  const X s = clamp((X(1.0) - t) / width, -1, 1);
  return piecewise(
      s, 0, [](const X& inside) { return X(2.0) - square(X(1.0) + inside); },
      [](const X& outside) { return square(X(1.0) - outside); });
}

/// d_ij: how much of its width a part keeps at the field f_j of another; 1 where that is 0, w from its surface inwards.
/// [de Groot 2003, sec. 3.5, with f_j where he prints f_i, so that nothing jumps; as a square]
template <Number X>
X kept_width(const X& f_j, double w) {
  return X(w) + X(1 - w) * square(X(1.0) - clamp(f_j, 0, 1));
}

/// Each child keeps its own width w_ii, wherever it is.   [de Groot 2003, solution 1]
struct SeparateWidths {
  static constexpr NodeInfo info{"separate", "Each child has its own weight, the diagonal's; others do not count."};
  static void keys(auto&&) {}
};
/// The mean of the blends of all pairs, i with the width w_ij and j with w_ji.   [de Groot 2003, solution 2]
struct PairWidths {
  static constexpr NodeInfo info{"pairs", "All pairs are blended by themselves, and the results added and scaled."};
  static void keys(auto&&) {}
};
/// A child is narrowed where others are near, by the weights w_ij.   [de Groot 2003, solution 3]
struct LocalWidths {
  static constexpr NodeInfo info{"local", "Each child is narrowed only near the others, by its weights for them."};
  static void keys(auto&&) {}
};
using WidthSolution = std::variant<LocalWidths, SeparateWidths, PairWidths>;

/// Weights of 1 are not the sum: g_0(t) is t^2 up to the surface.
struct WeightedBlend {
  static constexpr NodeInfo info{"weighted_blend",
                                 "Blend with a weight for each pair of children, for parts of very different sizes "
                                 "(de Groot's better blending).",
                                 2, any_number_of_children};
  static constexpr double least_weight = 1e-3;
  WidthSolution solution;
  std::vector<std::vector<double>> weights;

  static void keys(auto&& key) {
    key("solution", &WeightedBlend::solution, form::OneOf{}, "where the weights act");
    key("weights", &WeightedBlend::weights, form::Rows{.min = least_weight, .max = 1},
        "a row for each child, a column for each child: the share of its blending range that the child of the row "
        "keeps "
        "at the surface of that of the column; on the diagonal, that it keeps everywhere. All 1 when left out");
  }
  std::string problem(std::size_t children) const {
    bool square = weights.empty() || weights.size() == children;
    for (const auto& row : weights) square = square && row.size() == children;
    return square ? "" : "weights must have a row and a column for each child";
  }
  /// g_k(t) <= t^2 up to 1, for every k; each solution adds as many of them as there are children.
  double child_level(double level, std::size_t children) const {
    return std::sqrt(std::min(1.0, level / static_cast<double>(children)));
  }
  template <Number X>
  X value(std::span<const X> f) const {
    X sum(0.0);
    for (std::size_t i = 0; i < f.size(); ++i)
      if (upper(f[i]) > 0) sum += std::visit([&](const auto& how) { return share(how, f, i); }, solution);
    return sum;
  }

 private:
  // Narrower is a step to all that can be seen, and divides by nothing.
  static constexpr double least_width = 1e-9;

  double weight(std::size_t i, std::size_t j) const {
    return weights.empty() ? 1 : std::max(least_width, weights[i][j]);
  }

  template <Number X>
  X share(const SeparateWidths&, std::span<const X> f, std::size_t i) const {
    return narrowed(f[i], X(weight(i, i)));
  }
  template <Number X>
  X share(const PairWidths&, std::span<const X> f, std::size_t i) const {
    X sum(0.0);
    for (std::size_t j = 0; j < f.size(); ++j)
      if (j != i) sum += narrowed(f[i], X(weight(i, j)));
    return sum * X(1 / static_cast<double>(f.size() - 1));
  }
  template <Number X>
  X share(const LocalWidths&, std::span<const X> f, std::size_t i) const {
    X width(weight(i, i));
    for (std::size_t j = 0; j < f.size(); ++j)
      if (j != i && weight(i, j) < 1) width *= kept_width(f[j], weight(i, j));
    return narrowed(f[i], clamp(width, least_width, 1));
  }
};

}  // namespace marrow
