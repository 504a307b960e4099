// Sources of light, each sampled from the point that it lights.
#include "renderer/transport/lights/light.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "field/base/overloaded.h"
#include "materials/cosine.h"

namespace marrow {
namespace {

std::optional<LightSample> sample_sky(const ConstantSky& sky, const Receiver& at, Sample2 u) {
  const UnitVec3 local = sample_cosine(u);
  return LightSample{.wi = UnitVec3::unchecked(Frame::around(at.normal).to_world(local)),
                     .radiance = sky.radiance,
                     .distance = std::numeric_limits<double>::infinity(),
                     .pdf = cosine_pdf(local),
                     .delta = false};
}

std::optional<LightSample> sample_point(const PointSource& point, const Receiver& at) {
  const Vec3d to_light = point.position - at.position;
  const double distance2 = length_squared(to_light), distance = std::sqrt(distance2);
  if (!(dot(at.normal, to_light) > 0)) return std::nullopt;
  return LightSample{.wi = UnitVec3::unchecked(to_light / distance),
                     .radiance = point.intensity / distance2,
                     .distance = distance,
                     .pdf = 1,
                     .delta = true};
}

}  // namespace

std::optional<LightSample> Light::sample(const Receiver& at, Sample2 u) const {
  return std::visit(
      Overloaded{[&](const ConstantSky& s) { return sample_sky(s, at, u); },
                 [&](const Environment& e) { return e.sample(u); }, [&](const Sun& s) { return s.sample(at, u); },
                 [&](const Rectangle& r) { return r.sample(at, u); },
                 [&](const PointSource& p) { return sample_point(p, at); }},
      source_);
}

double Light::pdf(const Receiver& at, const UnitVec3& wi) const {
  return std::visit(
      Overloaded{[&](const ConstantSky&) { return std::max(dot(at.normal, wi), 0.0) * std::numbers::inv_pi; },
                 [&](const Environment& e) { return e.pdf(wi); }, [&](const Sun& s) { return s.pdf(wi); },
                 [&](const Rectangle& r) { return r.pdf(at, wi); }, [](const PointSource&) { return 0.0; }},
      source_);
}

Rgb Light::escaped(const UnitVec3& direction) const {
  return std::visit(Overloaded{[](const ConstantSky& s) { return s.radiance; },
                               [&](const Environment& e) { return e.escaped(direction); },
                               [&](const Sun& s) { return s.escaped(direction); },
                               [](const Rectangle&) { return Rgb{}; }, [](const PointSource&) { return Rgb{}; }},
                    source_);
}

std::optional<LightHit> Light::hit(const Ray& ray) const {
  if (const auto* rectangle = std::get_if<Rectangle>(&source_)) return rectangle->hit(ray);
  return std::nullopt;
}

bool Light::can_be_met() const {
  if (const auto* sun = std::get_if<Sun>(&source_)) return !sun->delta();
  return !std::holds_alternative<PointSource>(source_);
}

double Light::importance(const Vec3d& at) const {
  return std::visit(Overloaded{[](const ConstantSky& s) { return std::numbers::pi * luminance(s.radiance); },
                               [](const Environment& e) { return std::numbers::pi * luminance(e.mean()); },
                               [](const Sun& s) { return luminance(s.irradiance()); },
                               [&](const Rectangle& r) { return r.importance(at); },
                               [&](const PointSource& p) {
                                 return luminance(p.intensity) / std::max(length_squared(p.position - at), 1e-300);
                               }},
                    source_);
}

}  // namespace marrow
