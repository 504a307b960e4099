// The corrected field of a blend over the types of number of general trees.
#pragma once

#include "field/blend/blend_field.h"
#include "field/blend/bounds/blend_bounds.h"
#include "field/blend/local/local_blend.h"
#include "field/number/functions.h"
#include "field/tree/straight_way.h"

namespace marrow::tree {

/// value and gradient known as functions of the position, composed with the derivatives of the position.
template <std::size_t N, class T>
Jet<T, N> composed(const T& value, const Vec3<T>& gradient, const Vec3<Jet<T, N>>& p) {
  Jet<T, N> r(value);
  for (std::size_t i = 0; i < N; ++i)
    r.slope[i] = gradient.x * p.x.slope[i] + gradient.y * p.y.slope[i] + gradient.z * p.z.slope[i];
  return r;
}

inline Box3 box_of(const Vec3<Interval>& p) { return {{p.x.lo, p.y.lo, p.z.lo}, {p.x.hi, p.y.hi, p.z.hi}}; }

/// From bounds(box, stretch) of a ray, where it is straight of what lies on it alone.
template <class Bounds>
Jet<Interval, 1> on_ray(const Vec3<Jet<Interval, 1>>& p, const Bounds& bounds) {
  const Box3 box = box_of({p.x.value, p.y.value, p.z.value});
  if (const auto way = straight_way(p)) {
    const BlendBounds b = bounds(box, &*way);
    Jet<Interval, 1> r(b.value);
    r.slope[0] = b.along;
    return r;
  }
  const BlendBounds b = bounds(box, nullptr);
  return composed(b.value, b.gradient, p);
}

inline double blend_value(const BlendField& blend, const Vec3d& p) { return corrected_value(blend, p); }

template <std::size_t N>
Jet<double, N> blend_value(const BlendField& blend, const Vec3<Jet<double, N>>& p) {
  const BlendSample s = evaluate(blend, {p.x.value, p.y.value, p.z.value});
  return composed(s.corrected, s.corrected_gradient, p);
}

HessianJet blend_value(const BlendField&, const Vec3<HessianJet>&);

inline Interval blend_value(const BlendField& blend, const Vec3<Interval>& p) {
  return blend_bounds(blend, box_of(p), Wanted::Value).value;
}

template <std::size_t N>
Jet<Interval, N> blend_value(const BlendField& blend, const Vec3<Jet<Interval, N>>& p) {
  const BlendBounds b = blend_bounds(blend, box_of({p.x.value, p.y.value, p.z.value}));
  return composed(b.value, b.gradient, p);
}

inline Jet<Interval, 1> blend_value(const BlendField& blend, const Vec3<Jet<Interval, 1>>& p) {
  return on_ray(p, [&](const Box3& box, const Stretch* way) { return blend_bounds(blend, box, Wanted::Slopes, way); });
}

/// The same of a part of space.
inline double blend_value(const LocalBlend& blend, const Vec3d& p) { return blend.value(p); }

template <std::size_t N>
Jet<double, N> blend_value(const LocalBlend& blend, const Vec3<Jet<double, N>>& p) {
  const LocalBlend::Sample s = blend.evaluate({p.x.value, p.y.value, p.z.value});
  return composed(s.value, s.gradient, p);
}

inline Interval blend_value(const LocalBlend& blend, const Vec3<Interval>& p) {
  return blend.bounds(box_of(p), Wanted::Value).value;
}

template <std::size_t N>
Jet<Interval, N> blend_value(const LocalBlend& blend, const Vec3<Jet<Interval, N>>& p) {
  const BlendBounds b = blend.bounds(box_of({p.x.value, p.y.value, p.z.value}));
  return composed(b.value, b.gradient, p);
}

inline Jet<Interval, 1> blend_value(const LocalBlend& blend, const Vec3<Jet<Interval, 1>>& p) {
  return on_ray(p, [&](const Box3& box, const Stretch* way) { return blend.bounds(box, Wanted::Slopes, way); });
}

}  // namespace marrow::tree
