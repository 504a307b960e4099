// Where a field along a ray changes sides, by samples of its exact values: nothing of the tracer's bounds.
#pragma once

#include <optional>
#include <span>

#include "field/math/ray.h"
#include "field/tree/field_tree.h"

namespace marrow::test {

/// Samples in double with slopes: at even distances, ever denser around given places, and between two of them wherever
/// a cubic through values and slopes comes near 1, or is not met by a sample in its middle. That proves nothing; but it
/// finds what is as wide as a hundredth of the way, and around the given places what is as thin as 1e-10 of it.
class ChangeSearch {
 public:
  ChangeSearch(const FieldTree& tree, const Ray& ray) : tree_(tree), ray_(ray) {}

  /// Just after the first change of side in begin < t <= end.
  std::optional<double> first(double begin, double end, std::span<const double> places);
  /// The largest |f - 1| from t0 on, up to t1 or to where the side changes.
  double depth(double t0, double t1) const;
  double value(double t) const { return marrow::value(tree_, ray_.at(t)); }
  bool is_inside(double t) const { return value(t) >= 1; }
  /// Whether there were too many samples to go on; what came before is searched.
  bool gave_up() const { return samples_ > most_samples; }

 private:
  static constexpr int most_samples = 4000;
  // Of what is bounded: (f - 1) / (1 + |f - 1|).
  struct Sample {
    double t, u, slope;
    bool is_inside() const { return u >= 0; }
  };
  Sample at(double t);
  std::optional<double> between(const Sample& a, const Sample& b, int depth);
  static bool is_clear(const Sample& a, const Sample& middle, const Sample& b);

  const FieldTree& tree_;
  const Ray& ray_;
  int samples_ = 0;
};

}  // namespace marrow::test
