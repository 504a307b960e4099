// A blend along a skeleton: pieces blend with their neighbours there, not with what comes near from elsewhere.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "field/number/functions.h"
#include "field/tree/node_info.h"

namespace marrow {

/// Each child i gathers its own field and those of the others, each times the weights w(f) of i and of all children on
/// the way from i to it along the graph; of several shortest ways the best counts. w falls smoothly from 1 to 0 as a
/// field falls below `threshold`. The value is the largest sum that a child gathers.
/// Continuous; smooth where all that matters is linked by fields above the threshold; folds that are not so linked meet
/// as in a union, with a crease. The cut of Cani and Hornus at a negligible field is the limit of a hard weight, which
/// would tear the field there.   [Cani, Hornus 2001, sec. 6]
struct RestrictedBlend {
  static constexpr NodeInfo info{
      "restricted_blend",
      "Blend along a skeleton: its children are pieces that blend with their neighbours and, "
      "through them, with the neighbours of those. Other pieces that come near do not blend.",
      1, any_number_of_children};
  double threshold = 0.1;
  std::vector<std::vector<double>> neighbours;

  static void keys(auto&& key) {
    key("threshold", &RestrictedBlend::threshold, form::positive,
        "field below which a child passes ever less of what lies behind it");
    key("neighbours", &RestrictedBlend::neighbours, form::Rows{.min = 0, .max = 1e9},
        "pairs of neighbours, as numbers of children counted from 0; when left out, each child and the next");
  }
  std::string problem(std::size_t children) const;
  double child_level(double level, std::size_t children) const { return level / static_cast<double>(children); }

  template <Number X>
  X value(std::span<const X> f) const {
    return neighbours.empty() ? along_chain(f) : over_graph(f);
  }

 private:
  /// 0 at 0, 1 from the threshold on, C1.
  template <Number X>
  X passed(const X& f) const {
    return X(1.0) - square(X(1.0) - clamp(f * X(1 / threshold), 0, 1));
  }
  template <Number X>
  X along_chain(std::span<const X> f) const;
  template <Number X>
  X over_graph(std::span<const X> f) const;
  template <Number X>
  static X gathered(std::span<const X> f, std::span<const X> passed, const std::vector<std::vector<std::size_t>>& links,
                    std::size_t start);
  std::vector<std::vector<std::size_t>> links(std::size_t children) const;
};

/// What comes from behind is f + w(f) * (what comes from there).
template <Number X>
X RestrictedBlend::along_chain(std::span<const X> f) const {
  std::vector<X> before(f.size(), X(0.0));
  for (std::size_t i = 1; i < f.size(); ++i) before[i] = f[i - 1] + passed(f[i - 1]) * before[i - 1];
  X most(0.0), behind(0.0);
  for (std::size_t i = f.size(); i-- > 0;) {
    most = max(most, f[i] + passed(f[i]) * (before[i] + behind));
    behind = f[i] + passed(f[i]) * behind;
  }
  return most;
}

template <Number X>
X RestrictedBlend::over_graph(std::span<const X> f) const {
  std::vector<X> weights(f.size());
  for (std::size_t i = 0; i < f.size(); ++i) weights[i] = passed(f[i]);
  const auto linked = links(f.size());
  X most(0.0);
  for (std::size_t i = 0; i < f.size(); ++i)
    if (upper(f[i]) > 0) most = max(most, gathered<X>(f, weights, linked, i));
  return most;
}

/// In the order of the steps from the start; a child's weight is settled before its turn comes.
template <Number X>
X RestrictedBlend::gathered(std::span<const X> f, std::span<const X> passed,
                            const std::vector<std::vector<std::size_t>>& links, std::size_t start) {
  constexpr std::size_t unreached = any_number_of_children;
  std::vector<std::size_t> steps(f.size(), unreached), order{start};
  std::vector<X> weight(f.size(), X(1.0));
  steps[start] = 0;
  X sum(0.0);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t at = order[k];
    sum += weight[at] * f[at];
    const X onward = weight[at] * passed[at];
    for (const std::size_t next : links[at]) {
      if (steps[next] == unreached) {
        steps[next] = steps[at] + 1;
        weight[next] = onward;
        order.push_back(next);
      } else if (steps[next] == steps[at] + 1) {
        weight[next] = max(weight[next], onward);
      }
    }
  }
  return sum;
}

}  // namespace marrow
