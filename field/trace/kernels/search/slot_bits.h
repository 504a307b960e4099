// Which slots of a block may hold surface, and which of their eighths. Part of block_kernels_<set>.cpp.

// Of a slot in its block, by its layers: six bits for the slot in its octant, x first, then three for the octant.
template <class Int>
inline Int slot_address(const Int (&layer)[3]) {
  return ((layer[0] | layer[0] << 4) & 0x043) | ((layer[1] << 2 | layer[1] << 5) & 0x08c) |
         ((layer[2] << 4 | layer[2] << 6) & 0x130);
}
// Of an eighth in its slot, by sixteen layers.
template <class Int>
inline Int eighth_address(const Int (&layer)[3]) {
  return (layer[0] & 1) | (layer[1] & 1) << 1 | (layer[2] & 1) << 2;
}
template <class Int>
inline Int octant_of(Int address) {
  return address >> 6;
}

// The bits of a block's 8 x 8 x 8 slots, by their addresses. Octants that no ray has come to before come as they do.
struct SlotWords {
  static constexpr int count = 16;  // two for each octant
  int words[count];
  int known;  // a bit for each octant

  void take_known(const BlockView& block) {
    std::uint64_t octants[count / 2];
    known = static_cast<int>(block.known_surface(octants));
    __builtin_memcpy(words, octants, sizeof words);
  }
  void need(const BlockView& block, int octant) {
    if (known >> octant & 1) return;
    const std::uint64_t slots = block.surface(octant);
    __builtin_memcpy(words + 2 * octant, &slots, sizeof slots);
    known |= 1 << octant;
  }
};

// For a ray, or the rays of a packet, which may be in several cells.
template <class F>
class SlotBits;

template <>
class SlotBits<float> {
 public:
  explicit SlotBits(const BlocksOf<float>& block) : block_(block.block) { words_.known = 0; }
  bool at(int address, bool active) {
    if (!active) return false;
    words_.need(*block_, octant_of(address));
    return words_.words[address >> 5] >> (address & 31) & 1;
  }

 private:
  const BlockView* block_;
  SlotWords words_;
};

template <>
class SlotBits<PacketFloat> {
 public:
  SlotBits() = default;
  // `words`: of each cell; `rays`: those that may be asked for.
  SlotBits(const BlocksOf<PacketFloat>& blocks, SlotWords* words, PacketMask rays)
      : cells_(blocks.cells), words_(words), place_(blocks.cell * ints_per_cell) {
    const int cell = blocks.cell[__builtin_ctz(rays.bits())];
    if (!any(rays & (blocks.cell != cell))) of_all_ = &words[cell];
    find_known();
  }
  PacketMask at(PacketInt address, PacketMask active) {
    const PacketInt octant = octant_of(address);
    const PacketMask unknown = active & ((known_ >> octant & 1) == 0);
    if (any(unknown)) need(unknown, octant);
    return (word(address >> 5) >> (address & 31) & 1) != 0;
  }

 private:
  static constexpr int ints_per_cell = sizeof(SlotWords) / sizeof(int);

  const int* ints() const { return words_->words; }
  PacketInt word(PacketInt index) const {
    return of_all_ != nullptr ? picked(of_all_->words, index) : gather(ints(), place_ + index);
  }
  void find_known() { known_ = gather(&words_->known, place_); }
  [[gnu::noinline, gnu::cold]] void need(PacketMask rays, PacketInt octant) {
    for (unsigned left = rays.bits(); left != 0; left &= left - 1) {
      const int lane = __builtin_ctz(left), cell = place_[lane] / ints_per_cell;
      words_[cell].need(*cells_[cell].block, octant[lane]);
    }
    find_known();
  }

  const CellRays* cells_ = nullptr;
  SlotWords* words_ = nullptr;
  const SlotWords* of_all_ = nullptr;  // where all rays are in one cell
  PacketInt place_{}, known_{};
};

// Which eighths of slots may hold surface, a byte for each slot: for a ray, or for those of a packet. Either all
// blocks of a blend tell which eighths may hold surface, or none does.
template <class F>
class Eighths;

template <>
class Eighths<float> {
 public:
  explicit Eighths(const BlocksOf<float>& blocks) : block_(blocks.block) {}
  bool told() const { return block_->tells_eighths; }
  int of_slot(int address, bool active) const { return active ? block_->eighths_of(address) : 0; }

 private:
  const BlockView* block_;
};

template <>
class Eighths<PacketFloat> {
 public:
  Eighths() = default;
  Eighths(const BlocksOf<PacketFloat>& blocks, PacketMask rays) : blocks_(blocks) {
    const int first = __builtin_ctz(rays.bits());
    told_ = blocks.of(first).tells_eighths;
    if (!told_) return;
    for (unsigned left = rays.bits(); left != 0; left &= left - 1) {
      const int lane = __builtin_ctz(left);
      bytes_[lane] = blocks.of(lane).eighths;
    }
    if (!any(rays & (blocks.cell != blocks.cell[first]))) of_all_ = reinterpret_cast<const int*>(bytes_[first]);
  }
  bool told() const { return told_; }
  PacketInt of_slot(PacketInt address, PacketMask active) const {
    const PacketInt eighths = four_about(address, active) >> ((address & 3) << 3) & 0xff;
    const PacketMask unknown = active & (eighths == static_cast<int>(unknown_eighths));
    return any(unknown) ? found(unknown, address, eighths) : eighths;
  }

 private:
  // Other threads may write these bytes meanwhile: a byte as a whole, once, from unknown to what it tells. The gather,
  // of which C++ knows no atomic one, sees one or the other, as processors load aligned words whole.
  PacketInt four_about(PacketInt address, PacketMask active) const {
    return of_all_ != nullptr ? gather(of_all_, address >> 2) : gather_from(bytes_, address & ~3, active);
  }
  [[gnu::noinline, gnu::cold]] PacketInt found(PacketMask unknown, PacketInt address, PacketInt eighths) const {
    alignas(sizeof(NativeInt)) int all[packet_lanes];
    const NativeInt before = eighths;
    __builtin_memcpy(all, &before, sizeof all);
    for (unsigned left = unknown.bits(); left != 0; left &= left - 1) {
      const int lane = __builtin_ctz(left);
      all[lane] = blocks_.of(lane).eighths_of(address[lane]);
    }
    return load_native(all);
  }

  BlocksOf<PacketFloat> blocks_;
  const unsigned char* bytes_[packet_lanes] = {};
  const int* of_all_ = nullptr;  // where all rays are in one cell
  bool told_ = false;
};
