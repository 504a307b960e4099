#include "renderer/app/input/ray_list.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include <fmt/core.h>

#include "renderer/app/text/number_rows.h"
#include "renderer/scene/form.h"

namespace marrow {
namespace {

constexpr std::size_t without_range = 6, with_range = 8;

std::optional<RowProblem> read_ray(std::span<const Word> words, ListedRay& ray) {
  std::array<double, with_range> n{0, 0, 0, 0, 0, 0, ray.t_min, ray.t_max};
  const bool is_endless = words.size() == with_range && words[with_range - 1].text == "inf";
  if (auto wrong = read_numbers(words.first(is_endless ? with_range - 1 : words.size()), n)) return wrong;
  if (words.size() != without_range && words.size() != with_range)
    return RowProblem{fmt::format("found {} numbers", words.size()), words[0]};
  ray = {{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, n[6], n[7]};
  for (std::size_t k = 0; k < 3; ++k)
    if (std::fabs(n[k]) > largest_length)
      return RowProblem{fmt::format("the origin lies beyond {:g}, as no scene does", largest_length), words[k]};
  if (ray.direction == Vec3d{}) return RowProblem{"the direction is 0 0 0", words[3]};
  if (ray.t_min < 0) return RowProblem{"t_min is below 0", words[6]};
  if (ray.t_max < ray.t_min) return RowProblem{"t_max is below t_min", words[7]};
  return std::nullopt;
}

}  // namespace

double ListedRay::unit() const {
  const double scale = max_component(abs(direction));
  return scale * length(direction / scale);
}

// Products are rounded: the range is as much wider, so that a t that was told is found again by a range which ends
// there.
Ray ListedRay::ray() const {
  return {origin, normalize(direction), t_min * unit() * (1 - 0x1p-52), t_max * unit() * (1 + 0x1p-52)};
}

double ListedRay::t_of(double distance) const { return std::clamp(distance / unit(), t_min, t_max); }

Result<std::vector<ListedRay>> read_rays(std::istream& in, const std::string& name, SourceCache& sources) {
  std::vector<ListedRay> rays;
  const auto take = [&](std::span<const Word> words) {
    ListedRay ray;
    auto wrong = read_ray(words, ray);
    if (!wrong) rays.push_back(ray);
    return wrong;
  };
  const auto status =
      read_rows(in, name, sources,
                "a ray is ox oy oz dx dy dz, or that and t_min t_max, 0 <= t_min <= t_max, with blanks between", take);
  if (!status) return status.why();
  return rays;
}

}  // namespace marrow
