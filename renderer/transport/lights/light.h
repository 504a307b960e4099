// Sources of light, each sampled from the point that it lights.
#pragma once

#include <optional>
#include <variant>

#include "field/math/ray.h"
#include "materials/rgb.h"
#include "materials/sample.h"
#include "renderer/transport/lights/environment.h"
#include "renderer/transport/lights/receiver.h"
#include "renderer/transport/lights/rectangle.h"
#include "renderer/transport/lights/sun.h"

namespace marrow {

/// The same radiance from everywhere.
struct ConstantSky {
  Rgb radiance;
};

struct PointSource {
  Vec3d position;
  Rgb intensity;  ///< per steradian
};

/// One of a closed set of lights. Directions point away from the receiver.
class Light {
 public:
  using Source = std::variant<ConstantSky, Environment, Sun, Rectangle, PointSource>;
  explicit Light(Source source) : source_(std::move(source)) {}

  /// Nothing where the light cannot reach the receiver.
  std::optional<LightSample> sample(const Receiver&, Sample2 u) const;
  /// Density of sample() per solid angle; 0 for lights of a single direction.
  double pdf(const Receiver&, const UnitVec3& wi) const;
  /// Radiance along a ray that meets nothing: lights at infinity.
  Rgb escaped(const UnitVec3& direction) const;
  /// Where a ray meets a light of finite distance and what it sees there.
  std::optional<LightHit> hit(const Ray&) const;
  /// Whether rays can meet it: neither a point nor a sun without extent.
  bool can_be_met() const;
  /// About the irradiance it can give at a point, to choose between lights.
  double importance(const Vec3d& at) const;

  const Source& source() const { return source_; }

 private:
  Source source_;
};

}  // namespace marrow
