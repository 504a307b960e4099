// Measured indices of refraction of metals.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "materials/rgb.h"

namespace marrow {

/// The complex index n + ik, one value a channel.
struct ComplexIndex {
  Rgb n, k;
};

/// Nothing for an unknown name. `aluminum` is `aluminium`.
std::optional<ComplexIndex> metal(std::string_view name);

/// All known names, for messages and schemas.
std::vector<std::string_view> metal_names();

}  // namespace marrow
