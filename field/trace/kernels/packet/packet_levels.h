// The levels in which the rays of a packet are searched, one for each cell. Part of block_kernels_<set>.cpp.

class PacketLevels {
 public:
  // Of the cells of these rays; returns the rays whose levels are good together. Of those that are not kept these are
  // so many at most, and where two cells are given the same memory, that of the later one.
  template <const FieldLevel& (BlockView::*Make)() const>
  LaneSet make(const CellRays* cells, const int (&cell_of)[packet_size], const LaneSet& rays) {
    constexpr bool fine = Make == &BlockView::fine;
    LaneSet asked;  // of cells, which are no more than lanes
    count_ = 0;
    rays.for_each([&](int ray) {
      const int cell = cell_of[ray];
      if (asked.has(cell)) return;
      asked.add(cell);
      const BlockView& block = *cells[cell].block;
      of_[cell] = block.kept_level(block.owner, fine);
      if (of_[cell] == nullptr) not_kept_[count_++] = static_cast<short>(cell);
      else __builtin_prefetch(of_[cell]);  // rays that come to lanes read it
    });
    if (count_ == 0) return rays;
    make_others<Make, fine>(cells);
    LaneSet ready;
    rays.for_each([&](int ray) {
      if (of_[cell_of[ray]] != nullptr) ready.add(ray);
    });
    return ready;
  }
  const FieldLevel& operator[](int cell) const { return *of_[cell]; }

 private:
  static constexpr short nobody = -1;
  static constexpr int most_made = 96;

  // What is asked for comes while others are made.
  template <const FieldLevel& (BlockView::*Make)() const, bool Fine>
  void make_others(const CellRays* cells) {
    constexpr int ahead = 4;
    const int count = count_ < most_made ? count_ : most_made;
    clear_owners(count);
    const auto view = [&](int i) -> const BlockView& { return *cells[not_kept_[i]].block; };
    for (int i = 0; i < count + 2 * ahead; ++i) {
      if (i < count) view(i).ask_for_level(view(i).owner, Fine, false);
      if (i >= ahead && i - ahead < count) view(i - ahead).ask_for_level(view(i - ahead).owner, Fine, true);
      if (i < 2 * ahead) continue;
      const int cell = not_kept_[i - 2 * ahead];
      of_[cell] = &(view(i - 2 * ahead).*Make)();
      const int before = own(cell);
      if (before != nobody) of_[before] = nullptr;
    }
  }

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
  short not_kept_[packet_size];   // cells whose levels are not
  int count_ = 0;                 // of these
  short owner_[2 * packet_size];  // of each level that is not kept, by its address
  int bits_;                      // of the number of those in use
};
