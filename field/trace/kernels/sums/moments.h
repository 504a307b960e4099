// Moments of far sources (far_field.h), and bounds of the field over the octants of a cube. Part of
// block_kernels_<set>.cpp.

constexpr int monomials_to(int degree) { return (degree + 1) * (degree + 2) * (degree + 3) / 6; }
constexpr int in_eights(int count) { return (count + 7) / 8 * 8; }

// Sums of f y^k over inverted sources for all monomials of degree <= FarDegree, and of f tau y^k for one degree more.
// Sources wait until there are some, and then come monomials of the same powers of x and y at a time: their sums stay
// in registers, each the last one's product times z.
template <int FarDegree>
class MomentSums {
 public:
  static constexpr int degree = FarDegree + 1;

  // One inverted source in each lane.
  void add(V16 x, V16 y, V16 z, V16 field, V16 tau) {
    if (waiting_ == most_waiting) add_waiting();
    split(x, x_[waiting_]), split(y, y_[waiting_]), split(z, z_[waiting_]);
    split(field, field_[waiting_]), split(tau, tau_[waiting_]);
    ++waiting_;
  }

  void write(float* f_out, float* potential_out) {
    add_waiting();
    write_sums(f_, FarDegree, f_out);
    write_sums(potential_, degree, potential_out);
  }

 private:
  // To degree 8 sums are 25 KB, and sixteen groups 6 KB more, which a first cache of 32 KB holds.
  static constexpr int most_waiting = 16, f_count = in_eights(monomials_to(FarDegree)),
                       potential_count = in_eights(monomials_to(degree));
  static_assert(potential_count <= most_far_moments);
  using Part = Native[natives];

  void add_waiting() {
    Native* f = f_[0];
    Native* potential = potential_[0];
    for (int a = 0; a <= degree; ++a) {
      for (int i = 0; i < waiting_; ++i)
        for (int part = 0; part < natives; ++part) {
          if (a > 0) field_[i][part] *= x_[i][part];
          product_[i][part] = field_[i][part];
        }
      add_powers_of_y<degree>(degree - a, f, potential);
    }
    waiting_ = 0;
  }

  // Of all powers of y up to `most`, which is at most Most.
  template <int Most>
  void add_powers_of_y(int most, Native*& f, Native*& potential) {
    if (most == Most) {
      add_powers_of_z<Most>(f, potential);
      f += Most * natives, potential += (Most + 1) * natives;
      for (int i = 0; i < waiting_; ++i)
        for (int part = 0; part < natives; ++part) product_[i][part] *= y_[i][part];
      --most;
    }
    if constexpr (Most > 0) add_powers_of_y<Most - 1>(most, f, potential);
  }

  // Of the products so far, times the powers of z below Most for the field, up to Most for the potential.
  template <int Most>
  void add_powers_of_z(Native* f, Native* potential) const {
    for (int part = 0; part < natives; ++part) {
      if constexpr (Most > 0) {
        Native sums[Most];
        for (int c = 0; c < Most; ++c) sums[c] = f[c * natives + part];
        for (int i = 0; i < waiting_; ++i) {
          Native product = product_[i][part];
          const Native z = z_[i][part];
          for (int c = 0; c < Most; ++c, product *= z) sums[c] += product;
        }
        for (int c = 0; c < Most; ++c) f[c * natives + part] = sums[c];
      }
      Native sums[Most + 1];
      for (int c = 0; c <= Most; ++c) sums[c] = potential[c * natives + part];
      for (int i = 0; i < waiting_; ++i) {
        Native product = product_[i][part] * tau_[i][part];
        const Native z = z_[i][part];
        for (int c = 0; c <= Most; ++c, product *= z) sums[c] += product;
      }
      for (int c = 0; c <= Most; ++c) potential[c * natives + part] = sums[c];
    }
  }

  // In the order of far_field.h, eight at a time.
  template <int Count>
  static void write_sums(const Part (&sums)[Count], int degree_of_sums, float* out) {
    float in_turn[Count];
    for (int i = 0; i < Count; i += 8) {
      V16 eight[12] = {};
      for (int k = 0; k < 8; ++k) eight[k] = joined(sums[i + k]);
      float s[16];
      sum_lanes(eight, s);
      for (int k = 0; k < 8; ++k) in_turn[i + k] = s[k];
    }
    const float* next = in_turn;
    for (int a = 0; a <= degree_of_sums; ++a)
      for (int b = 0; a + b <= degree_of_sums; ++b)
        for (int c = 0; a + b + c <= degree_of_sums; ++c, ++next) {
          const int rest = b + c;
          out[monomials_to(a + rest - 1) + rest * (rest + 1) / 2 + c] = *next;
        }
  }

  // Of each power of x one of y after the other, and of each of these all of z.
  Part f_[f_count] = {}, potential_[potential_count] = {};
  Part x_[most_waiting], y_[most_waiting], z_[most_waiting], field_[most_waiting], tau_[most_waiting];
  Part product_[most_waiting];  // of the field with powers of x and y
  int waiting_ = 0;
};

template <int FarDegree>
inline void sum_moments(const float* group, int groups, float* f_out, float* potential_out) {
  MomentSums<FarDegree> sums;
  for (int k = 0; k < groups; ++k, group += floats_per_group)
    sums.add(load(group), load(group + 16), load(group + 32), load(group + 48), load(group + 64));
  sums.write(f_out, potential_out);
}

void far_moments(const float* groups, int count, int far_degree, float* f_out, float* potential_out) {
  if (far_degree == 4) sum_moments<4>(groups, count, f_out, potential_out);
  else if (far_degree == 6) sum_moments<6>(groups, count, f_out, potential_out);
  else sum_moments<8>(groups, count, f_out, potential_out);
}

// One kind of pieces (one exponent) against one ball. Distances are lowered and raised by what rounding can do to
// numbers of the size of the coordinates. Fields are powers of tau / d, which no scale can make overflow early.
template <int Exponent>
inline void add_octant(const float* group, int groups, int exponent, const float (&c)[3], float radius,
                       OctantBounds& out) {
  V16 a[12] = {}, touching{}, thinness{};
  for (int k = 0; k < groups; ++k, group += floats_per_piece_group) {
    const V16 wx = c[0] - load(group), wy = c[1] - load(group + 16), wz = c[2] - load(group + 32);
    const V16 ax = load(group + 48), ay = load(group + 64), az = load(group + 80);
    const V16 along = (wx * ax + wy * ay + wz * az) * load(group + 96);  // 1 / length^2
    const V16 t = select(along < 0.0F, V16{}, select(along > 1.0F, splat(1), along));
    const V16 dx = wx - ax * t, dy = wy - ay * t, dz = wz - az * t;
    const V16 share = load(group + 112), taper = load(group + 128), tau = load(group + 144), size = load(group + 160),
              reach = load(group + 176);
    const V16 d = root_of(dx * dx + dy * dy + dz * dz), slack = 2e-6F * (1.0F + d + size);
    const V16 nearest = d - (radius + reach + slack), high = tau / larger(nearest, splat(1e-4F));
    const V16 field = share * power_of(high, exponent);
    // All of a piece is within its length of the nearest point, and nowhere thinner than its thin end.
    const V16 thin = tau - select(taper < 0.0F, V16{} - taper, taper), middle = tau / larger(d, 0.5F * tau);
    const V16 low = thin / (d + size + radius + slack);
    const V16 weight = share * power_of(middle, exponent);
    a[0] += field;
    a[1] += field * high;
    a[2] += select(thin > 0.0F, share * (tau / thin) * power_of(low, exponent), V16{});
    a[3] += weight;
    a[4] += weight * tau;
    touching = larger(touching, select(share > 0.0F, 1e-4F - nearest, splat(-1)));
    // Farther away than this a piece is no more than a hundredth of the field, and its own surface ends before.
    const V16 thick = larger(load(group + 192), splat(1e-9F));
    const V16 thinness_here = select(nearest < 4.0F * thick, 1.0F / thick, V16{});
    thinness = larger(thinness, select(share > 0.0F, thinness_here, V16{}));
  }
  float s[16];
  sum_lanes(a, s);
  out.f_high += s[0] * (1 + rounding);
  out.gradient_high += static_cast<float>(exponent) * s[1] * (1 + rounding);
  out.f_low += s[2] * (1 - rounding);
  out.weight += s[3];
  out.weighted_radius += s[4];
  if (largest_lane(touching) > 0) out.touches = true;
  out.thinness = max_of(out.thinness, largest_lane(thinness));
}

void octant_bounds(const float* pieces, int curve_groups, int point_groups, int degree, OctantBounds* out) {
  constexpr float radius = 0.5F * 1.7320509F;  // of a half-sized cube, rounded up
  const float* points = pieces + static_cast<long>(curve_groups) * floats_per_piece_group;
  for (int octant = 0; octant < 8; ++octant) {
    float c[3];
    for (int i = 0; i < 3; ++i) c[i] = octant >> i & 1 ? 0.5F : -0.5F;
    out[octant] = {};
    if (degree == 4) add_octant<4>(pieces, curve_groups, 4, c, radius, out[octant]);
    else add_octant<0>(pieces, curve_groups, degree, c, radius, out[octant]);
    if (point_groups > 0) add_octant<0>(points, point_groups, degree - 1, c, radius, out[octant]);
  }
}
