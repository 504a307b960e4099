// The field at a point, with all derivatives that its normal needs. Part of block_kernels_<set>.cpp.

// A far polynomial (f, Gx, Gy, Gz) with its derivatives by the first `Known` of z, y and x, the order in which Horner's
// rule takes them; it does not depend on the others yet.
// Value: V4, all four of one place; PacketFloat, one of each place.
template <int Known, class Value>
struct FarSlopes {
  Value value, slope[Known];
};

// The coordinate that becomes the `Known`-th known one.
template <int Known, class F>
struct Coordinate {
  F at;
};

template <class Coefficients, int Known, class F>
inline auto operator*(const Coefficients& c, const Coordinate<Known, F>& x) {
  using Value = decltype(c * x.at);
  FarSlopes<Known, Value> r{.value = c * x.at, .slope = {}};
  r.slope[Known - 1] = c - Value{};
  return r;
}
template <int Before, class Value, int Known, class F>
inline FarSlopes<Known, Value> operator*(const FarSlopes<Before, Value>& p, const Coordinate<Known, F>& x) {
  FarSlopes<Known, Value> r{.value = p.value * x.at, .slope = {}};
  for (int i = 0; i < Before; ++i) r.slope[i] = p.slope[i] * x.at;
  r.slope[Known - 1] = Before == Known ? r.slope[Known - 1] + p.value : p.value;
  return r;
}
template <int Known, class Value, class Coefficients>
inline FarSlopes<Known, Value> operator+(FarSlopes<Known, Value> p, const Coefficients& c) {
  p.value += c;
  return p;
}
template <int Known, class Value, int Fewer>
inline FarSlopes<Known, Value> operator+(FarSlopes<Known, Value> p, const FarSlopes<Fewer, Value>& c) {
  p.value += c.value;
  for (int i = 0; i < Fewer; ++i) p.slope[i] += c.slope[i];
  return p;
}

template <class Far, class F>
inline auto far_slopes(const FieldLevel& level, const Far& far, const F* p) {
  const Coordinate<3, F> x{p[0]};
  const Coordinate<2, F> y{p[1]};
  const Coordinate<1, F> z{p[2]};
  return far_polynomial(level, far, x, y, z);
}

// A / f of angle_field.h, as in march.h.
inline void find_mean_share(const FieldLevel& angle, int degree, const float p[3], PointField& out) {
  FullSums<float> s;
  V16 nearest{};
  for_each_list(angle, degree, FullSummer{p, nearest, s});
  const auto far = far_slopes(angle, AllFour{angle.far}, p);
  const float inverse = 1 / max_of(out.f, 1e-20F), n = static_cast<float>(degree);
  out.share = (s.f + far.value[0]) * inverse;
  for (int i = 0; i < 3; ++i)
    out.share_gradient[i] = (s.df[i] + far.slope[2 - i][0] - out.share * out.gradient[i]) * inverse;
  out.share_bend = n * (n + 1) * (s.second + out.share * out.second) * inverse;
}

// `d`: the far field's derivatives by x, y and z.
template <class F, class Far, class Slopes>
inline void add_far_slopes(const Far& value, const Slopes (&d)[3], FullSums<F>& s) {
  s.f += value[0];
  for (int i = 0; i < 3; ++i) {
    s.df[i] += d[i][0];
    s.g[i] += value[i + 1];
    s.h[i] += d[i][i + 1];
  }
  s.h[3] += d[0][2];
  s.h[4] += d[0][3];
  s.h[5] += d[1][3];
}

// As in sampler.h.
template <class F>
inline F nearest_distance(F largest_inverse) {
  return 1.0F / root_of(max_of(largest_inverse, 1.0F / 64));
}

inline PointField point_field(const FieldLevel& level, int degree, const float p[3]) {
  FullSums<float> s;
  V16 nearest{};
  for_each_list(level, degree, FullSummer{p, nearest, s});
  const auto far = far_slopes(level, AllFour{level.far}, p);
  const V4 d[3] = {far.slope[2], far.slope[1], far.slope[0]};
  add_far_slopes(far.value, d, s);
  PointField out{};
  out.f = s.f;
  out.second = s.second;
  out.third = s.third;
  out.nearest = nearest_distance(largest_lane(nearest));
  __builtin_memcpy(out.gradient, s.df, sizeof s.df);
  __builtin_memcpy(out.si_gradient, s.g, sizeof s.g);
  __builtin_memcpy(out.hessian, s.h, sizeof s.h);
  if (level.angle != nullptr) find_mean_share(*level.angle, degree, p, out);
  return out;
}

// FullSummer for a place in each lane.
struct FullSummerInRays {
  const PacketFloat (&p)[3];
  PacketFloat& nearest;
  FullSums<PacketFloat>& out;
  template <int Exponent>
  void add(const float* group, int groups, int exponent) const {
    using Sums = SumsInRays<SumsAllAround<Exponent>>;
    Native sums[Sums::count];
    const Native place[3] = {p[0], p[1], p[2]};
    Sums(SourceList{group, groups}, place, {exponent}).find(sums);
    nearest = larger(nearest, sums[Sums::nearest]);
    PacketFloat in_lanes[16];
    for (int i = 0; i < 16; ++i) in_lanes[i] = sums[i];
    add_full_list(static_cast<float>(Exponent > 0 ? Exponent : exponent), in_lanes, out);
  }
};

inline void add_far_in_rays(const FieldLevel& level, const PacketFloat (&p)[3], FullSums<PacketFloat>& s) {
  PacketFloat value[4], d[3][4];
  for (int k = 0; k < 4; ++k) {
    const auto far = far_slopes(level, OneOfFour{level.far + k}, p);
    value[k] = far.value;
    for (int i = 0; i < 3; ++i) d[i][k] = far.slope[2 - i];
  }
  add_far_slopes(value, d, s);
}

// point_field() of the first `count` lanes.
inline void fields_in_rays(const FieldLevel& level, int degree, const PacketFloat (&p)[3], int count, PointField* out) {
  FullSums<PacketFloat> s;
  PacketFloat inverse{};
  for_each_list(level, degree, FullSummerInRays{p, inverse, s});
  add_far_in_rays(level, p, s);
  const PacketFloat nearest = nearest_distance(inverse);
  for (int i = 0; i < count; ++i) {
    PointField& of = out[i];
    of.share = of.share_bend = 0;
    for (float& g : of.share_gradient) g = 0;
    of.f = s.f[i];
    of.nearest = nearest[i];
    of.second = s.second[i];
    of.third = s.third[i];
    for (int k = 0; k < 3; ++k) {
      of.gradient[k] = s.df[k][i];
      of.si_gradient[k] = s.g[k][i];
    }
    for (int k = 0; k < 6; ++k) of.hessian[k] = s.h[k][i];
  }
}

void point_fields(const FieldLevel& level, int degree, const PlacesInLanes& places, int count, PointField* out) {
  for (int first = 0; first < count; first += packet_lanes) {
    const int here = count - first < packet_lanes ? count - first : packet_lanes;
    if (level.angle == nullptr && is_faster_in_lanes(curves_of(level), here) &&
        is_faster_in_lanes(points_of(level), here)) {
      const PacketFloat p[3] = {load_native(places.at[0] + first), load_native(places.at[1] + first),
                                load_native(places.at[2] + first)};
      fields_in_rays(level, degree, p, here, out + first);
      continue;
    }
    for (int i = first; i < first + here; ++i) {
      const float p[3] = {places.at[0][i], places.at[1][i], places.at[2][i]};
      out[i] = point_field(level, degree, p);
    }
  }
}
