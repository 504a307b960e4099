// What a sample of the field tells. Part of block_kernels_<set>.cpp.

// Rounding of a sum of positive float terms: below 4e-6 relative for up to 2000 sources.
inline constexpr float rounding = 4e-6F;
// Coordinates up to 1.7 in float are off by 2^-24 as t, as product and as sum; those of sources by 2^-24.
inline constexpr float position_rounding = 2e-7F;

// How alpha is given: one angle; one for each skeleton; by polynomials of its share of the range (share_patches.h).
enum class Angle { One, Mean, Patched };

// What a sample knows of an angle that varies.
template <Angle Rule, class F>
struct SampleShare {};

// Its share of the range, as summed at a place near by or here; how that changes along the ray from there, and how it
// bends at most: infinite when any share may hold.
struct SummedShare {
  float share = 0, slope = 0, bend = infinity;
  float t = 0, distance = 1;  // of the place; to its nearest source
};

// By how much the residual bends with the share, and by how much another share may lower it.
template <>
struct SampleShare<Angle::Mean, float> {
  SummedShare summed;
  float residual_bend, residual_drop;
};
template <class F>
struct SampleShare<Angle::Patched, F> {
  OnWay<SharePatch::degree, F> share;  // its Taylor coefficients along the ray
  F residual_bend;
};

// The field at one t, raised by the level's certified error, with what bounds it nearby.
template <Angle Rule, class F = float>
struct SampleOf : SampleShare<Rule, F> {
  F t;
  RaySums<F> s;
  F y;         // |G|
  F distance;  // to the nearest source, at most
  F residual;  // lower V(u) - v of the field raised by the level's errors and by rounding: where it is positive the
               // field is surely below 1, and some step from here can be certified
  F nominal;   // V(u) - v of the field as summed
  // Where the residual is not positive but the nominal one is, "outside" can still be told to within rounding: by the
  // nominal curve and unraised sums. What is passed over in that way is reported.
  MaskOf<F> sure;        // residual > 0
  F margin;              // the residual, or the nominal one when not sure
  F raise;               // factor of f and |G| for what rounding can do
  F slope;               // derivative of the residual along the ray
  F v, v_slope, curve;   // v, its derivative along the ray, and V(u) of the field as summed
  F x_weight, y_weight;  // -d residual / dx, dy
  // (v / V)^(-1/(n-1)) - 1 of the field as summed, and its derivative: 0 on the surface and, near a single skeleton,
  // linear in the distance from it, so that Newton's method on it jumps well [Aydinlilar and Zanni 2021].
  F scaled, scaled_slope;

  F newton_step() const { return -scaled / scaled_slope; }
};

// The samples of some rays of a packet.
template <Angle Rule>
inline void assign(PacketMask mask, SampleOf<Rule, PacketFloat>& to, const SampleOf<Rule, PacketFloat>& from) {
  using Sample = SampleOf<Rule, PacketFloat>;
  for (PacketFloat Sample::*part :
       {&Sample::t, &Sample::y, &Sample::distance, &Sample::residual, &Sample::nominal, &Sample::margin, &Sample::raise,
        &Sample::slope, &Sample::v, &Sample::v_slope, &Sample::curve, &Sample::x_weight, &Sample::y_weight,
        &Sample::scaled, &Sample::scaled_slope})
    assign(mask, to.*part, from.*part);
  assign(mask, to.s, from.s);
  assign(mask, to.sure, from.sure);
  if constexpr (Rule == Angle::Patched) {
    for (int i = 0; i <= SharePatch::degree; ++i) assign(mask, to.share.c[i], from.share.c[i]);
    assign(mask, to.residual_bend, from.residual_bend);
  }
}
