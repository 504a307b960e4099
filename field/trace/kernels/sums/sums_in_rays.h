// Sums over a list of sources at as many places as there are lanes, a source at a time. Part of
// block_kernels_<set>.cpp.

// Counted in registers of sources: those of a place take some four more, to be added up over lanes, and places in lanes
// take one for each source, and four. Where a group is several registers it is six more, 18 for a group's sources, and
// 24: then lanes pay only for short lists. (AVX2 on a processor without AVX-512, degree 4: lists of 1, 2, 8 and 15
// groups take 33, 43, 91 and 156 ns a place, 198, 355, 830 and 1420 ns in lanes, for eight places.)
inline bool is_faster_in_lanes(const SourceList& sources, int places) {
  if constexpr (natives == 1) return places * (sources.count + 4) > lanes * sources.count + 4;
  else return places * (natives * sources.count + 6) > 18 * sources.count + 24;
}

// The order of summation, and so the bits, are those of one place with sixteen sources at a time: sources that are in
// the same lane of their groups, a chain, are added one after the other, and their sums as lane_sums() adds lanes. The
// first lanes that it adds to each other are half of them apart, so that in a single group these are chains of two.
template <class Kind>
class SumsInRays {
 public:
  static constexpr int nearest = Kind::count, count = nearest + 1;  // the last is the largest 1 / d^2

  // `list` has at least one group. There is a place in each lane.
  SumsInRays(const SourceList& list, const Native (&place)[3], const Kind& kind)
      : first_(list.groups), groups_(list.count), place_(place), kind_(kind) {
    const float* const last = first_ + static_cast<long>(groups_ - 1) * floats_per_group;
    while (in_last_ > 1 && is_unused(last + in_last_ - 1)) --in_last_;
  }

  void find(Native (&sums)[count]) const {
    Native waiting[4][count];  // sums of chains, of pairs of chains, of fours and of eights: one of each at most
    int depth = 0;
    for (int turn = 0; turn < chains(); ++turn) {
      if (!has_chain(turn)) continue;
      Native a[count];
      sum_chain(chain_in(turn), a);
      for (int level = 0; 1 << level < chains(); ++level) {
        if (turn >> level & 1) add(waiting[--depth], a);
        else if (has_chain((turn >> level | 1) << level)) break;
      }
      copy(a, waiting[depth++]);
    }
    copy(waiting[0], sums);
  }

 private:
  // As SourceGroups leaves lanes: without a field, and too far away to be the nearest.
  static bool is_unused(const float* source) { return source[48] == 0.0F && source[0] == unused_place; }

  bool in_one_group() const { return groups_ == 1; }
  int chains() const { return in_one_group() ? lanes / 2 : lanes; }
  // Neighbours in turns are added to each other, then pairs of them, and so on.
  int chain_in(int turn) const {
    constexpr int in_turn[lanes] = {0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15};
    return in_one_group() ? in_turn[turn] / 2 : in_turn[turn];
  }
  int sources_in(int chain) const {
    return in_one_group() ? (chain < in_last_) + (chain + lanes / 2 < in_last_) : groups_ - (chain >= in_last_);
  }
  bool has_chain(int turn) const { return sources_in(chain_in(turn)) > 0; }

  void sum_chain(int chain, Native (&a)[count]) const {
    const float* const first = first_ + chain;
    const int stride = in_one_group() ? lanes / 2 : floats_per_group;
    for_each_source<typename Kind::Ready>(
        first, sources_in(chain), stride,
        [&](const float* source) {
          return kind_.ready(source[48] - Native{}, source[64] - Native{},
                             Away(place_[0] - source[0], place_[1] - source[16], place_[2] - source[32]));
        },
        [&](const float* source, const auto& ready) {
          kind_.add(ready, source[64] - Native{}, [&](int i, Native term) { a[i] = term; });
          a[nearest] = ready.inverse;
        },
        [&](const float* source, const auto& ready) {
          kind_.add(ready, source[64] - Native{}, [&](int i, Native term) { a[i] += term; });
          a[nearest] = larger(a[nearest], ready.inverse);
        });
  }

  static void add(const Native (&from)[count], Native (&a)[count]) {
#pragma GCC unroll 17
    for (int i = 0; i < nearest; ++i) a[i] += from[i];
    a[nearest] = larger(from[nearest], a[nearest]);
  }
  static void copy(const Native (&from)[count], Native (&to)[count]) {
#pragma GCC unroll 17
    for (int i = 0; i < count; ++i) to[i] = from[i];
  }

  const float* first_;
  const int groups_;
  int in_last_ = lanes;  // lanes of the last group up to the last that has a source
  const Native (&place_)[3];
  const Kind& kind_;
};
