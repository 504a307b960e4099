// The field at a place of each ray of a packet. Part of block_kernels_<set>.cpp.
//
// Each ray has sums over the sources of its own level, in the order of a single ray: sixteen sources at a time, ray by
// ray. Where enough rays share a level it is faster to take a source at a time, a ray in each lane; the order of
// summation stays the same, and so do the bits.

// Rays that share a level, as bits of lanes.
struct RaysOfLevel {
  const FieldLevel* level;
  unsigned lanes;
};

class LevelGroups {
 public:
  LevelGroups(const LevelOf<PacketFloat>& levels, unsigned active) {
    for (unsigned left = active; left != 0; left &= ~groups_[count_++].lanes) {
      const int lane = __builtin_ctz(left);
      groups_[count_] = {&levels[lane], levels.like(lane) & active};
    }
  }
  const RaysOfLevel* begin() const { return groups_; }
  const RaysOfLevel* end() const { return groups_ + count_; }

 private:
  RaysOfLevel groups_[packet_lanes];
  int count_ = 0;
};

// The columns of the rows of some rays, with 0 for all others; left as they are where there are none.
inline void find_columns_of(unsigned rays, V16 (&rows)[packet_lanes], PacketFloat (&columns)[lanes]) {
  if (rays == 0) return;
  for (unsigned left = ~rays & all_lane_bits; left != 0; left &= left - 1) rows[__builtin_ctz(left)] = V16{};
  find_columns(rows, columns);
}

struct PacketSummer {
  const PacketFloat (&at)[3];
  const PacketRays& rays;
  const LevelGroups& groups;
  unsigned active;
  PacketFloat& nearest;
  RaySums<PacketFloat>& out;

  // `list` is that of a level.
  template <int Exponent, class ListOf>
  void add(const ListOf& list, int exponent) const {
    V16 rows[packet_lanes];
    unsigned in_rows = 0, in_lanes = 0;
    for (const RaysOfLevel& same : groups) {
      const SourceList sources = list(*same.level);
      if (sources.count == 0) continue;
      if (is_faster_in_lanes(sources, __builtin_popcount(same.lanes))) {
        in_lanes |= same.lanes;
      } else {
        in_rows |= same.lanes;
        for (unsigned left = same.lanes; left != 0; left &= left - 1)
          rows[__builtin_ctz(left)] = sums_of<Exponent>(__builtin_ctz(left), sources, exponent);
      }
    }
    if ((in_rows | in_lanes) == 0) return;
    PacketFloat columns[lanes] = {};
    find_columns_of(in_rows, rows, columns);
    for (const RaysOfLevel& same : groups)
      if (same.lanes & in_lanes) find_in_lanes<Exponent>(list(*same.level), exponent, same.lanes, columns);
    add_columns(columns, in_rows | in_lanes, static_cast<float>(Exponent > 0 ? Exponent : exponent));
  }

 private:
  template <int Exponent>
  V16 sums_of(int lane, const SourceList& sources, int exponent) const {
    // To subtract 0 changes nothing, so that no instruction does it.
    const auto all = [](float v) { return v - Native{}; };
    const Probe probe{{all(at[0][lane]), all(at[1][lane]), all(at[2][lane])},
                      {all(rays.direction[0][lane]), all(rays.direction[1][lane]), all(rays.direction[2][lane])}};
    V16 close{};
    const V16 sums =
        sum_groups(sources.groups, sources.count, probe.place, SumsAlong<Exponent>{probe.direction, exponent}, close);
    return with_largest_last(sums, close);
  }

  template <int Exponent>
  void find_in_lanes(const SourceList& sources, int exponent, unsigned lanes_of, PacketFloat (&columns)[lanes]) const {
    using Sums = SumsInRays<SumsAlong<Exponent>>;
    const Probe probe{{at[0], at[1], at[2]}, {rays.direction[0], rays.direction[1], rays.direction[2]}};
    Native sums[Sums::count];
    Sums(sources, probe.place, {probe.direction, exponent}).find(sums);
    const PacketMask which = PacketMask(lanes_of);
    for (int i = 0; i < Sums::nearest; ++i) assign(which, columns[i], sums[i]);
    assign(which, columns[lanes - 1], sums[Sums::nearest]);
  }

  // A ray without a list of this exponent keeps its sums as they are.
  void add_columns(const PacketFloat (&columns)[lanes], unsigned having, float m) const {
    nearest = larger(nearest, columns[lanes - 1]);
    if (having == active) return add_list(m, columns, rays.direction, out);
    RaySums<PacketFloat> more = out;
    add_list(m, columns, rays.direction, more);
    assign(PacketMask(having), out, more);
  }
};

// The far polynomials and their derivatives along the rays: f, G, f', G'.
class PacketFar {
 public:
  PacketFar(const LevelGroups& groups, const OnRay<PacketFloat> (&p)[3]) : p_(p) {
    unsigned in_rows = 0;
    V16 rows[packet_lanes];
    for (const RaysOfLevel& same : groups) {
      if (__builtin_popcount(same.lanes) >= worth_lanes) continue;
      in_rows |= same.lanes;
      for (unsigned left = same.lanes; left != 0; left &= left - 1)
        rows[__builtin_ctz(left)] = of_ray(*same.level, __builtin_ctz(left));
    }
    find_columns_of(in_rows, rows, columns_);
    for (const RaysOfLevel& same : groups)
      if (!(same.lanes & in_rows)) find_in_lanes(*same.level, same.lanes);
  }

  void add_to(RaySums<PacketFloat>& s) const {
    s.f += columns_[0];
    s.df += columns_[4];
    for (int i = 0; i < 3; ++i) {
      s.g[i] += columns_[1 + i];
      s.dg[i] += columns_[5 + i];
    }
  }

 private:
  // In lanes the four components go one by one, for a single ray together.
  static constexpr int worth_lanes = (packet_lanes + 3) / 4 + 1;

  V16 of_ray(const FieldLevel& level, int lane) const {
    struct Row {
      V4 value, slope, unused[2];
    };
    const auto of_lane = [&](int k) { return OnRay<float>{p_[k].at[lane], p_[k].slope[lane]}; };
    const FarSlope<V4> far = far_polynomial(level, AllFour{level.far}, of_lane(0), of_lane(1), of_lane(2));
    const Row row{far.value, far.slope, {}};
    V16 v;
    static_assert(sizeof row == sizeof v);
    __builtin_memcpy(&v, &row, sizeof v);
    return v;
  }

  void find_in_lanes(const FieldLevel& level, unsigned lanes_of) {
    const PacketMask which = PacketMask(lanes_of);
    for (int k = 0; k < 4; ++k) {
      const FarSlope<PacketFloat> far = far_polynomial(level, OneOfFour{level.far + k}, p_[0], p_[1], p_[2]);
      assign(which, columns_[k], far.value);
      assign(which, columns_[4 + k], far.slope);
    }
  }

  const OnRay<PacketFloat> (&p_)[3];
  PacketFloat columns_[lanes] = {};
};

// Adds the sources of the levels, and their far fields, at places on the rays; `nearest`: the largest 1 / d^2.
inline void add_level(const LevelOf<PacketFloat>& levels, int degree, const OnRay<PacketFloat> (&p)[3],
                      const PacketRays& rays, PacketMask active, RaySums<PacketFloat>& sums, PacketFloat& nearest) {
  const unsigned lanes_of = active.bits();
  if (lanes_of == 0) return;
  const LevelGroups groups(levels, lanes_of);
  const PacketFloat at[3] = {p[0].at, p[1].at, p[2].at};
  const PacketSummer summer{at, rays, groups, lanes_of, nearest, sums};
  const auto add = [&](const auto& list, int exponent) {
    with_exponent(exponent, [&](auto known) { summer.template add<decltype(known)::exponent>(list, exponent); });
  };
  add(curves_of, degree);
  add(points_of, degree - 1);
  PacketFar(groups, p).add_to(sums);
}
