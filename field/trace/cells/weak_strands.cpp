#include "field/trace/cells/weak_strands.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "field/math/elementary.h"
#include "field/skeleton/distance.h"
#include "field/skeleton/skeletons.h"

namespace marrow {
namespace {

// Of shares. What patches are off is 40 times as much (share_patches.cpp).
constexpr double most_left_out = 1e-6;

struct FieldRange {
  double least = 0, most = 0;
};

// A field of the inverse kernel is a mean of 1 / d^n (of points 1 / d^(n - 1)), and no d changes by more than the
// reach.
FieldRange field_around(double field, double distance, double reach, int degree) {
  return {.least = field / integer_power(1 + reach / distance, degree),
          .most = distance > reach ? field / integer_power(1 - reach / distance, degree)
                                   : std::numeric_limits<double>::infinity()};
}

std::vector<FieldRange> fields_around(const BlendField& blend, const Vec3d& center, double reach) {
  std::vector<FieldRange> of_strand(blend.direction_bounds.size());
  const auto add = [&](const auto& list, const auto& field) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      const auto& skeleton = list.skeletons[i];
      const FieldRange range = field_around(field(skeleton), distance_to(skeleton, center), reach, blend.degree);
      of_strand[list.strands[i]].least += range.least;
      of_strand[list.strands[i]].most += range.most;
    }
  };
  constexpr auto values = Derivatives::ScaleInvariant;
  add(blend.points, [&](const PointSkeleton& s) { return point_field<values>(s, center, blend.degree).value; });
  add(blend.segments, [&](const SegmentSkeleton& s) { return segment_field<values>(s, center, blend.degree).value; });
  return of_strand;
}

// That strand for strand the second strongest has at least.
double least_of_second(const std::vector<FieldRange>& fields) {
  double first = 0, second = 0;
  for (const FieldRange& f : fields) {
    second = std::max(second, std::min(first, f.least));
    first = std::max(first, f.least);
  }
  return second;
}

constexpr auto none = std::numeric_limits<std::uint32_t>::max();

// The strands that count get numbers in their order. The weakest ones that together are little do not.
std::vector<std::uint32_t> numbers_of_counting(const std::vector<FieldRange>& fields) {
  std::vector<std::pair<double, std::size_t>> by_strength;
  for (std::size_t i = 0; i < fields.size(); ++i) by_strength.emplace_back(fields[i].most, i);
  std::ranges::sort(by_strength);
  const double allowed = most_left_out * least_of_second(fields);
  std::vector<std::uint32_t> numbers(fields.size(), 0);
  double left_out = 0;
  for (const auto& [most, strand] : by_strength) {
    left_out += most;
    if (!(left_out < allowed)) break;  // where the second is 0 in double, too, all are kept
    numbers[strand] = none;
  }
  std::uint32_t count = 0;
  for (std::uint32_t& number : numbers)
    if (number != none) number = count++;
  return numbers;
}

template <class Skeleton>
void add_numbered(const PrimitiveList<Skeleton>& from, const std::vector<std::uint32_t>& numbers,
                  PrimitiveList<Skeleton>& to) {
  for (std::size_t i = 0; i < from.size(); ++i) {
    const std::uint32_t number = numbers[from.strands[i]];
    if (number == none) continue;
    to.skeletons.push_back(from.skeletons[i]);
    to.strands.push_back(number);
  }
}

}  // namespace

AngleShare exact_share(const BlendField& blend, const AngleRange& range, const Vec3d& p) {
  const double width = range.most - range.least;
  const AlphaSample alpha = alpha_at(blend, p);
  return {std::clamp((alpha.value - range.least) / width, 0.0, 1.0), alpha.gradient / width};
}

BlendField counting_strands(const BlendField& blend, const Vec3d& center, double reach) {
  const std::vector<std::uint32_t> numbers = numbers_of_counting(fields_around(blend, center, reach));
  BlendField out;
  out.degree = blend.degree;
  out.kernel = blend.kernel;
  out.kernel_shape = blend.kernel_shape;
  out.alpha = blend.alpha;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (numbers[i] != none) out.direction_bounds.push_back(blend.direction_bounds[i]);
  add_numbered(blend.points, numbers, out.points);
  add_numbered(blend.segments, numbers, out.segments);
  return out;
}

}  // namespace marrow
