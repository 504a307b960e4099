// Memory asked for ahead, for rays that wait for lanes. Part of block_kernels_<set>.cpp.

// For the sources of a level and the far polynomials behind them; of much of it the beginning: then processors have
// seen where it goes on. Into the second cache: the lists of all lanes are more than the first one holds, and what
// waits for it keeps others waiting.
inline void ask_for_sums(const FieldLevel& level) {
  constexpr int floats_in_line = 16, most_lines = 128;
  constexpr int in_group = floats_per_group / floats_in_line, of_coarse_far = 3;
  const int all = (level.curve_groups + level.point_groups) * in_group + of_coarse_far;
  for (int i = 0; i < (all < most_lines ? all : most_lines); ++i)
    __builtin_prefetch(level.sources + i * floats_in_line, 0, 2);
}

// Rays come to lanes lowest first: for as many as have come some more are asked for, whose sums can be found without
// waiting when it is their turn. level_of(ray) is the address of a level.
template <class LevelOfRay>
class RaysAhead {
 public:
  RaysAhead(const LaneSet& waiting, const LevelOfRay& level_of) : unasked_(waiting), level_of_(level_of) {
    ask(packet_lanes);
  }
  void ask(int count) {
    unasked_.take(count, [&](int ray) {
      const FieldLevel* const level = level_of_(ray);
      if (level != asked_) ask_for_sums(*level);  // neighbours of the camera share theirs
      asked_ = level;
    });
  }

 private:
  const FieldLevel* asked_ = nullptr;
  LaneSet unasked_;
  LevelOfRay level_of_;
};
