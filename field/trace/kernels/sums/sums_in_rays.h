// Sums over a list of sources at as many places as there are lanes, a source at a time. Part of
// block_kernels_<set>.cpp.
//
// The order of summation, and so the bits, are those of one place with sixteen sources at a time.

// Counted in groups of sources: the sums of a place take some four more, to be added up over lanes, those in lanes one
// for each source, and four.
inline bool is_faster_in_lanes(const SourceList& sources, int places) {
  const int of_sixteen = places * (lanes / packet_lanes);
  return of_sixteen * (2 * sources.count + 8) > 2 * lanes * sources.count + 8;
}

// add(share, radius, away, sums) adds a source; the last of the sums is the largest 1 / d^2.
template <int Count, class Add>
class SumsInRays {
 public:
  SumsInRays(const SourceList& list, const PacketFloat (&at)[3], const Add& add)
      : first_(list.groups), groups_(list.count), at_(at), add_(add) {
    const float* const last = first_ + static_cast<long>(groups_ - 1) * floats_per_group;
    while (in_last_ > 0 && is_unused(last + in_last_ - 1)) --in_last_;
  }

  void find(Native (&sums)[Count]) const { sum_from(0, 1, sums); }

 private:
  // As SourceGroups leaves lanes: without a field, and too far away to be the nearest.
  static bool is_unused(const float* source) { return source[48] == 0.0F && source[0] == unused_place; }

  // Over every stride-th lane of sources from the first one on, as lane_sums() does it.
  void sum_from(int first, int stride, Native (&sums)[Count]) const {
    if (stride == lanes) return sum_lane(first, sums);
    sum_from(first, 2 * stride, sums);
    if (groups_ == 1 && first + stride >= in_last_) return;
    Native others[Count];
    sum_from(first + stride, 2 * stride, others);
    for (int i = 0; i < Count - 1; ++i) sums[i] += others[i];
    sums[Count - 1] = larger(sums[Count - 1], others[Count - 1]);
  }

  void sum_lane(int lane, Native (&sums)[Count]) const {
    Native a[Count] = {};
    const auto away = [&](const float* source) {
      return Away(at_[0] - source[0], at_[1] - source[16], at_[2] - source[32]);
    };
    for_each_source(
        first_ + lane, groups_ - (lane >= in_last_), floats_per_group, away,
        [&](const float* source, const Away& d) { add_(source[48] - Native{}, source[64] - Native{}, d, a); });
    __builtin_memcpy(sums, a, sizeof a);
  }

  const float* first_;
  const int groups_;
  int in_last_ = lanes;  // sources of the last group
  const PacketFloat (&at_)[3];
  const Add& add_;
};

template <int Count, class Add>
inline void sums_in_rays(const SourceList& list, const PacketFloat (&at)[3], const Add& add, Native (&sums)[Count]) {
  SumsInRays<Count, Add>(list, at, add).find(sums);
}
