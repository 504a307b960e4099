// The levels in which the rays of a packet are searched, one for each cell. Part of block_kernels_<set>.cpp.

class PacketLevels {
 public:
  // Of the cells of these rays; returns the rays whose levels are good together. Two cells whose levels are not kept
  // may be given the same memory for them: then that of the later one is good.
  template <const FieldLevel& (BlockView::*Make)() const>
  LaneSet make(const CellRays* cells, int cell_count, const int (&cell_of)[packet_size], const LaneSet& rays) {
    clear_owners(cell_count);
    LaneSet made, good;  // of cells, which are no more than lanes
    rays.for_each([&](int ray) {
      const int cell = cell_of[ray];
      if (made.has(cell)) return;
      made.add(cell);
      good.add(cell);
      of_[cell] = &(cells[cell].block->*Make)();
      __builtin_prefetch(of_[cell]);  // rays that come to lanes read it
      const int before = own(cell);
      if (before != nobody) good.remove(before);
    });
    if ((made & ~good).empty()) return rays;
    LaneSet ready;
    rays.for_each([&](int ray) {
      if (good.has(cell_of[ray])) ready.add(ray);
    });
    return ready;
  }
  const FieldLevel& operator[](int cell) const { return *of_[cell]; }

 private:
  static constexpr short nobody = -1;

  void clear_owners(int cell_count) {
    bits_ = 1;
    while (1 << bits_ < 2 * cell_count) ++bits_;
    __builtin_memset(owner_, 0xff, sizeof owner_[0] << bits_);
  }
  // The level of this cell is its own now. Returns the cell that had it before, if any.
  int own(int cell) {
    const auto address = reinterpret_cast<std::size_t>(of_[cell]);
    for (std::size_t at = address * 0x9e3779b97f4a7c15U >> (64 - bits_);; at = (at + 1) & ((1U << bits_) - 1)) {
      const short before = owner_[at];
      if (before != nobody && of_[before] != of_[cell]) continue;
      owner_[at] = static_cast<short>(cell);
      return before;
    }
  }

  const FieldLevel* of_[packet_size];
  short owner_[2 * packet_size];  // of each level, by its address
  int bits_;                      // of the number of those in use
};
