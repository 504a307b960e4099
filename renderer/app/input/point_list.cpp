#include "renderer/app/input/point_list.h"

#include <array>
#include <optional>
#include <span>

#include <fmt/core.h>

#include "renderer/app/text/number_rows.h"

namespace marrow {

Result<std::vector<Vec3d>> read_points(std::istream& in, const std::string& name, SourceCache& sources) {
  std::vector<Vec3d> points;
  const auto take = [&](std::span<const Word> words) -> std::optional<RowProblem> {
    std::array<double, 3> p{};
    if (auto wrong = read_numbers(words, p)) return wrong;
    if (words.size() != p.size()) return RowProblem{fmt::format("found {} numbers", words.size()), words[0]};
    points.push_back({p[0], p[1], p[2]});
    return std::nullopt;
  };
  const auto status = read_rows(in, name, sources, "a point is x y z, with blanks between", take);
  if (!status) return status.why();
  return points;
}

}  // namespace marrow
