// The corrected field of a blend over the types of number of general trees.
#pragma once

#include "field/blend/blend_field.h"
#include "field/blend/bounds/blend_bounds.h"
#include "field/blend/local/local_blend.h"
#include "field/number/functions.h"
#include "field/tree/place.h"

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

/// From bounds(box, within), of as little as is known to hold the place.
template <std::size_t N, class Bounds>
Jet<Interval, N> enclosed_at(const Place<Jet<Interval, N>>& at, const Bounds& bounds) {
  const auto part = at.part();
  const BlendBounds b = part ? bounds(part->box, Within(&part->shape)) : bounds(at.box(), Within());
  if constexpr (N == 1)
    if (part) {
      Jet<Interval, 1> r(b.value);
      r.slope[0] = b.along;
      return r;
    }
  return composed(b.value, b.gradient, at.p);
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
Jet<Interval, N> blend_value(const BlendField& blend, const Place<Jet<Interval, N>>& at) {
  return enclosed_at(
      at, [&](const Box3& box, const Within& within) { return blend_bounds(blend, box, Wanted::Slopes, within); });
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
Jet<Interval, N> blend_value(const LocalBlend& blend, const Place<Jet<Interval, N>>& at) {
  return enclosed_at(at,
                     [&](const Box3& box, const Within& within) { return blend.bounds(box, Wanted::Slopes, within); });
}

/// Of a place of which its enclosure is all that counts.
template <class Blend, Number X>
auto blend_value(const Blend& blend, const Place<X>& at) -> decltype(blend_value(blend, at.p)) {
  return blend_value(blend, at.p);
}

}  // namespace marrow::tree
