#include "renderer/output/colormap.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "renderer/output/colormap_tables.h"

namespace marrow {
namespace {

using Entry = std::array<std::uint8_t, 3>;
using Table = std::array<Entry, 256>;

constexpr unsigned digit(char c) { return static_cast<unsigned>(c <= '9' ? c - '0' : c - 'a' + 10); }

constexpr Table parse(std::string_view hex) {
  Table table{};
  for (std::size_t i = 0; i < table.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = 6 * i + 2 * k;
      table[i][k] = static_cast<std::uint8_t>(16 * digit(hex[at]) + digit(hex[at + 1]));
    }
  return table;
}

constexpr Table grey_ramp() {
  Table table{};
  for (std::size_t i = 0; i < table.size(); ++i) table[i].fill(static_cast<std::uint8_t>(i));
  return table;
}

struct Named {
  std::string_view name;
  Table table;
};

constexpr std::array<Named, 5> maps = {{
    {"viridis", parse(colormap_tables::viridis)},
    {"cividis", parse(colormap_tables::cividis)},
    {"turbo", parse(colormap_tables::turbo)},
    {"coolwarm", parse(colormap_tables::coolwarm)},
    {"grey", grey_ramp()},
}};

}  // namespace

Result<Colormap> Colormap::named(std::string_view name) {
  std::string known;
  for (const Named& m : maps) {
    if (m.name == name) return Colormap(m.table);
    known += (known.empty() ? "" : ", ") + std::string(m.name);
  }
  return with_hint(failure("unknown colour map \"" + std::string(name) + "\""), "known colour maps: " + known);
}

std::vector<std::string> Colormap::names() {
  std::vector<std::string> names;
  for (const Named& m : maps) names.emplace_back(m.name);
  return names;
}

std::array<float, 3> Colormap::operator()(double t) const {
  if (std::isnan(t)) return {1, 0, 1};
  const double at = std::clamp(t, 0.0, 1.0) * static_cast<double>(table_.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(at), table_.size() - 2);
  const double w = at - static_cast<double>(i);
  std::array<float, 3> color{};
  for (std::size_t k = 0; k < 3; ++k)
    color[k] = static_cast<float>(((1 - w) * table_[i][k] + w * table_[i + 1][k]) / 255);
  return color;
}

}  // namespace marrow
