// The stretches of a ray in slots of a block that may hold surface. Part of block_kernels_<set>.cpp.

// Of a slot in its block, by its layers: six bits for the slot in its octant, x first, then three for the octant.
template <class Int>
inline Int slot_address(const Int (&layer)[3]) {
  return ((layer[0] | layer[0] << 4) & 0x043) | ((layer[1] << 2 | layer[1] << 5) & 0x08c) |
         ((layer[2] << 4 | layer[2] << 6) & 0x130);
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

// Which of the eight layers of slots along an axis the ray is in, and where it leaves it. The outer layers go on
// beyond the block, so that no rounding of its faces cuts off the end of a ray.
template <class F>
class Layer {
 public:
  using Mask = MaskOf<F>;
  using Int = IntOf<F>;

  Layer() = default;
  Layer(F origin, F direction, F t) : origin_(origin), inverse_(1 / nonzero(direction)) {
    const Mask upward = nonzero(direction) > 0.0F;
    onward_ = select(upward, Int{} + 1, Int{} - 1);
    index = layer_of(origin + direction * t);
    plane_ = index + select(upward, Int{} + 1, Int{});
    leave = t_at_plane();
    look_ahead();
  }

  void step(Mask rays) {
    index = select(rays, index + onward_, index);
    leave = select(rays, leave_next_, leave);
    plane_ = select(rays, plane_ + onward_, plane_);
    leave_next_ = t_at_plane();
  }

  Int index{};
  F leave{};

 private:
  // Planes are one step ahead, so that no step has to wait for a place.
  void look_ahead() {
    plane_ = plane_ + onward_;
    leave_next_ = t_at_plane();
  }
  F t_at_plane() const {
    const F t = (to_float(plane_) * 0.25F - 1 - origin_) * inverse_;
    return select((plane_ <= 0) | (plane_ >= 8), all_lanes<F>(infinity), t);
  }

  F origin_{}, inverse_{}, leave_next_{};
  Int onward_{}, plane_{};
};

template <class F>
struct Run {
  F begin{}, end{};
  ShareLine<F> share{};  // of the range of angles, where patches give it
};

// From slot to slot along the ray [Amanatides and Woo 1987]; neighbours are joined. Bounds of slots hold a little
// beyond them, by far more than planes and places are rounded.
template <Angle Rule, class F>
class Runs {
 public:
  using Mask = MaskOf<F>;

  Runs(const BlocksOf<F>& blocks, const SlotBits<F>& slots, const RayOf<F>& ray, F t0, F t1)
      : blocks_(blocks), slots_(slots), t_(t0), end_(t1), ended_(!(t0 < t1)) {
    for (int k = 0; k < 3; ++k) layers_[k] = Layer<F>(ray.origin[k], ray.direction[k], t0);
  }

  // Finds the next run of each of these rays, and tells which have one.
  Mask next(const RayOf<F>& ray, Mask rays, Run<F>& run) {
    Mask found{}, open = rays & !ended_;
    Layer<F> layers[3] = {layers_[0], layers_[1], layers_[2]};  // of its own, for registers
    while (any(open)) {
      const F leave = min_of(min_of(layers[0].leave, layers[1].leave), min_of(layers[2].leave, end_));
      const IntOf<F> layer[3] = {layers[0].index, layers[1].index, layers[2].index};
      const Mask crossed = open & (leave > t_), surface = crossed & slots_.at(slot_address(layer), crossed);
      const Mask first = surface & !found;
      assign(first, run.begin, t_);
      assign(surface, run.end, leave);
      const Mask closed = found & crossed & !surface;
      found = found | surface;
      for (Layer<F>& l : layers) l.step(open & (l.leave <= leave));
      t_ = select(crossed, leave, t_);
      const Mask last = open & (leave >= end_);
      ended_ = ended_ | last;
      open = open & !closed & !last;
    }
    for (int k = 0; k < 3; ++k) layers_[k] = layers[k];
    if constexpr (Rule == Angle::Patched) assign(found, run.share, line_on(blocks_, ray, found, run.begin, run.end));
    return found;
  }

 private:
  BlocksOf<F> blocks_;
  SlotBits<F> slots_;
  Layer<F> layers_[3];
  F t_, end_;
  Mask ended_;
};
