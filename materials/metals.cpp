// Measured indices of refraction of metals.
#include "materials/metals.h"

#include <algorithm>
#include <array>

namespace marrow {
namespace {

struct NamedIndex {
  std::string_view name;
  ComplexIndex index;
};

// n and k at 630, 532 and 465 nm, near the primaries of Rec.709, interpolated linearly between measured wavelengths.
// Gold, silver, copper: Johnson & Christy 1972, Phys. Rev. B 6, 4370. Chromium, iron, nickel, palladium, titanium:
// Johnson & Christy 1974, Phys. Rev. B 9, 5056. Aluminium, platinum, tungsten: the Lorentz-Drude fit of
// Rakic et al. 1998, Appl. Opt. 37, 5271. Read from the tables of refractiveindex.info (public domain).
constexpr std::array<NamedIndex, 12> metals{{
    {"aluminium", {{1.327, 0.889, 0.637}, {7.272, 6.262, 5.490}}},
    {"aluminum", {{1.327, 0.889, 0.637}, {7.272, 6.262, 5.490}}},
    {"chromium", {{3.145, 3.034, 2.456}, {3.312, 3.330, 3.210}}},
    {"copper", {{0.275, 1.116, 1.247}, {3.373, 2.596, 2.456}}},
    {"gold", {{0.188, 0.544, 1.332}, {3.403, 2.231, 1.869}}},
    {"iron", {{2.892, 2.895, 2.646}, {3.065, 2.918, 2.805}}},
    {"nickel", {{1.990, 1.877, 1.765}, {4.094, 3.495, 3.048}}},
    {"palladium", {{1.765, 1.597, 1.445}, {4.275, 3.743, 3.351}}},
    {"platinum", {{2.310, 2.046, 1.887}, {4.147, 3.602, 3.224}}},
    {"silver", {{0.057, 0.054, 0.047}, {4.254, 3.429, 2.803}}},
    {"titanium", {{2.698, 2.479, 2.305}, {3.757, 3.351, 3.082}}},
    {"tungsten", {{3.669, 3.424, 3.375}, {2.887, 2.705, 2.544}}},
}};

}  // namespace

std::optional<ComplexIndex> metal(std::string_view name) {
  const auto found = std::ranges::find(metals, name, &NamedIndex::name);
  if (found == metals.end()) return std::nullopt;
  return found->index;
}

std::vector<std::string_view> metal_names() {
  std::vector<std::string_view> names;
  for (const NamedIndex& m : metals) names.push_back(m.name);
  return names;
}

}  // namespace marrow
