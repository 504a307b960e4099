// Which slots of a cube a ray crosses. Part of block_kernels_<set>.cpp.

// Where a ray is in the four layers along an axis: the lanes of `low` and `high` name the planes of a layer. Layers
// share their planes, and so the t of them; the outer ones reach beyond the cube, so that no rounding of its faces cuts
// off the end of a ray. (Whole vectors throughout: narrower ones are widened through memory.)
struct Layers {
  V16 enter, leave;
  Layers(V16 low, V16 high, float origin, float direction) {
    const float inverse = 1 / nonzero(direction);
    const V16 a = (low - origin) * inverse, b = (high - origin) * inverse;
    enter = smaller(a, b);
    leave = larger(a, b);
  }
};

inline constexpr float far_out = 2;
alignas(64) inline constexpr float x_low[lanes] = {-far_out, -0.5F, 0, 0.5F, -far_out, -0.5F, 0, 0.5F,
                                                   -far_out, -0.5F, 0, 0.5F, -far_out, -0.5F, 0, 0.5F};
alignas(64) inline constexpr float x_high[lanes] = {-0.5F, 0, 0.5F, far_out, -0.5F, 0, 0.5F, far_out,
                                                    -0.5F, 0, 0.5F, far_out, -0.5F, 0, 0.5F, far_out};
alignas(64) inline constexpr float y_low[lanes] = {-far_out, -far_out, -far_out, -far_out, -0.5F, -0.5F, -0.5F, -0.5F,
                                                   0,        0,        0,        0,        0.5F,  0.5F,  0.5F,  0.5F};
alignas(64) inline constexpr float y_high[lanes] = {-0.5F, -0.5F, -0.5F, -0.5F, 0,       0,       0,       0,
                                                    0.5F,  0.5F,  0.5F,  0.5F,  far_out, far_out, far_out, far_out};

inline void insert(Walk& walk, int slot, float begin, float end) {
  int k = walk.count++;
  for (; k > 0 && walk.begin[k - 1] > begin; --k) {
    walk.begin[k] = walk.begin[k - 1];
    walk.end[k] = walk.end[k - 1];
    walk.slot[k] = walk.slot[k - 1];
  }
  walk.begin[k] = begin;
  walk.end[k] = end;
  walk.slot[k] = slot;
}

void walk(std::uint64_t slots, const LocalRay& ray, float t0, float t1, Walk& out) {
  const Layers x(load(x_low), load(x_high), ray.origin[0], ray.direction[0]),
      y(load(y_low), load(y_high), ray.origin[1], ray.direction[1]);
  const V16 enter = larger(larger(x.enter, y.enter), splat(t0)), leave = smaller(smaller(x.leave, y.leave), splat(t1));
  const float inverse = 1 / nonzero(ray.direction[2]);
  float z_enter[4], z_leave[4], plane = (-far_out - ray.origin[2]) * inverse;
  std::uint64_t left = 0;
  for (int k = 0; k < 4; ++k) {
    const float next = ((k < 3 ? -0.5F + 0.5F * static_cast<float>(k) : far_out) - ray.origin[2]) * inverse;
    z_enter[k] = min_of(plane, next);
    z_leave[k] = max_of(plane, next);
    plane = next;
    const Index16 met = larger(enter, splat(z_enter[k])) < smaller(leave, splat(z_leave[k]));
    left |= static_cast<std::uint64_t>(lane_bits(met)) << (lanes * k);
  }
  alignas(64) float column_enter[lanes], column_leave[lanes];
  __builtin_memcpy(column_enter, &enter, sizeof column_enter);
  __builtin_memcpy(column_leave, &leave, sizeof column_leave);
  out.count = 0;
  const bool backward = ray.direction[2] < 0;  // layer by layer as the ray comes, so that little is left to sort
  for (left &= slots; left != 0 && out.count < Walk::most;) {
    const int slot = backward ? 63 - __builtin_clzll(left) : __builtin_ctzll(left);
    left &= ~(std::uint64_t{1} << slot);
    const int column = slot & 15, layer = slot >> 4;
    insert(out, slot, max_of(column_enter[column], z_enter[layer]), min_of(column_leave[column], z_leave[layer]));
  }
}
