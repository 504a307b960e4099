// A material as its author wrote it.
#pragma once

#include <string>
#include <variant>

#include "materials/rgb.h"

namespace marrow {

/// Lambert reflection; `color` is the albedo, each channel in [0, 1]. `emission` is radiance that the surface sends out
/// by itself, >= 0; it is met by rays, not sampled as a light is.
struct DiffuseDescription {
  Rgb color{0.8};
  Rgb emission{0};
  friend bool operator==(const DiffuseDescription&, const DiffuseDescription&) = default;
};
/// Rough metal of measured index (n, k). `metal` is a name of materials/metals.h.
/// `roughness` in [0, 1]; the GGX width is roughness squared.
struct ConductorDescription {
  std::string metal = "gold";
  double roughness = 0.2;
  friend bool operator==(const ConductorDescription&, const ConductorDescription&) = default;
};
/// A clear dielectric coat of index `ior` and `roughness` over a diffuse base.
struct CoatedDescription {
  Rgb color{0.8};
  double roughness = 0.1;
  double ior = 1.5;
  friend bool operator==(const CoatedDescription&, const CoatedDescription&) = default;
};

using MaterialDescription = std::variant<DiffuseDescription, ConductorDescription, CoatedDescription>;

}  // namespace marrow
