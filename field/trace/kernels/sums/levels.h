// The level of the field in which a ray is searched: one, or another in each lane of a packet, whose rays may be in
// several cells. Part of block_kernels_<set>.cpp.

template <class F>
struct LevelOf;

template <>
struct LevelOf<float> {
  const FieldLevel& level;

  explicit LevelOf(const FieldLevel& l) : level(l) {}
  float f_error() const { return level.f_error; }
  float g_error() const { return level.g_error; }
  float far_bend() const { return level.far_bend; }
  float far_g_bend() const { return level.far_g_bend; }
};

template <>
struct LevelOf<PacketFloat> {
  // In all lanes, until they are set.
  explicit LevelOf(const FieldLevel& level) {
    for (int lane = 0; lane < packet_lanes; ++lane) set(lane, level, 0);
  }
  LevelOf(const LevelOf&) = delete;
  LevelOf& operator=(const LevelOf&) = delete;

  // That of a cell.
  void set(int lane, const FieldLevel& level, int cell) {
    of_[lane] = &level;
    cell_[lane] = cell;
    f_error_[lane] = level.f_error;
    g_error_[lane] = level.g_error;
    far_bend_[lane] = level.far_bend;
    far_g_bend_[lane] = level.far_g_bend;
  }
  const FieldLevel& operator[](int lane) const { return *of_[lane]; }
  // The lanes whose level is that of this one.
  unsigned like(int lane) const { return (PacketInt(load_native(cell_)) == cell_[lane]).bits(); }
  PacketFloat f_error() const { return load_native(f_error_); }
  PacketFloat g_error() const { return load_native(g_error_); }
  PacketFloat far_bend() const { return load_native(far_bend_); }
  PacketFloat far_g_bend() const { return load_native(far_g_bend_); }

 private:
  const FieldLevel* of_[packet_lanes];
  alignas(64) int cell_[packet_lanes];
  alignas(64) float f_error_[packet_lanes], g_error_[packet_lanes];
  alignas(64) float far_bend_[packet_lanes], far_g_bend_[packet_lanes];
};

// The block of a ray, or those of the rays in lanes.
template <class F>
struct BlocksOf;
template <>
struct BlocksOf<float> {
  const BlockView* block;
};
template <>
struct BlocksOf<PacketFloat> {
  const CellRays* cells = nullptr;
  PacketInt cell{};  // which of them is that of a lane
  const BlockView& of(int lane) const { return *cells[cell[lane]].block; }
};

// The level is the field itself: it tells what is inside.
template <class F>
inline MaskOf<F> is_exact(const LevelOf<F>& level) {
  return (level.f_error() <= 0.0F) & (level.g_error() <= 0.0F);
}
