// The stretches of a ray in slots of a block that may hold surface. Part of block_kernels_<set>.cpp.

// Of a slot by its layers.
template <class Int>
inline Int octant_of(const Int (&layer)[3]) {
  return (layer[0] >> 2) | (layer[1] >> 2) << 1 | (layer[2] >> 2) << 2;
}
template <class Int>
inline Int slot_in_octant(const Int (&layer)[3]) {
  return (layer[0] & 3) | (layer[1] & 3) << 2 | (layer[2] & 3) << 4;
}

// The bits of a block's 8 x 8 x 8 slots, octant by octant as rays come.
struct SlotWords {
  unsigned known = 0;  // a bit for each octant
  int words[16];       // two for each octant

  void need(const BlockView& block, int octant) {
    if (known >> octant & 1) return;
    const std::uint64_t slots = block.surface(octant);
    words[2 * octant] = static_cast<int>(static_cast<unsigned>(slots));
    words[2 * octant + 1] = static_cast<int>(static_cast<unsigned>(slots >> 32));
    known |= 1U << octant;
  }
};

// For a ray, or the rays of a packet, which may be in several cells.
template <class F>
class SlotBits;

template <>
class SlotBits<float> {
 public:
  explicit SlotBits(const BlocksOf<float>& block) : block_(block.block) {}
  bool at(const int (&layer)[3], bool active) {
    const int octant = octant_of(layer), slot = slot_in_octant(layer);
    if (!active) return false;
    words_.need(*block_, octant);
    return words_.words[2 * octant + (slot >> 5)] >> (slot & 31) & 1;
  }

 private:
  const BlockView* block_;
  SlotWords words_;
};

template <>
class SlotBits<PacketFloat> {
 public:
  SlotBits() = default;
  // `words`: of each cell.
  SlotBits(const BlocksOf<PacketFloat>& blocks, SlotWords* words)
      : cells_(blocks.cells), words_(words), place_(blocks.cell * ints_per_cell) {
    known_ = gather(ints(), place_);
  }
  PacketInt at(const PacketInt (&layer)[3], PacketInt active) {
    const PacketInt octant = octant_of(layer), slot = slot_in_octant(layer);
    const PacketInt unknown = active & ((known_ >> octant & 1) == 0);
    if (any(unknown)) need(unknown, octant);
    const PacketInt word = gather(ints() + 1, place_ + 2 * octant + (slot >> 5));
    return (word >> (slot & 31) & 1) != 0;
  }

 private:
  static constexpr int ints_per_cell = sizeof(SlotWords) / sizeof(int);

  const int* ints() const { return reinterpret_cast<const int*>(words_); }
  void need(PacketInt rays, PacketInt octant) {
    for (unsigned left = lane_bits(rays); left != 0; left &= left - 1) {
      const int lane = __builtin_ctz(left), cell = place_[lane] / ints_per_cell;
      words_[cell].need(*cells_[cell].block, octant[lane]);
    }
    known_ = gather(ints(), place_);
  }

  const CellRays* cells_ = nullptr;
  SlotWords* words_ = nullptr;
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
  Layer(F origin, F direction, F t)
      : origin_(origin), inverse_(1 / nonzero(direction)), upward_(nonzero(direction) > 0.0F) {
    index = layer_of(origin + direction * t);
    find_leave();
  }

  void step(Mask rays) {
    index = select(rays, index + select(upward_, Int{} + 1, Int{} - 1), index);
    find_leave();
  }

  Int index{};
  F leave{};

 private:
  void find_leave() {
    const Int plane = index + select(upward_, Int{} + 1, Int{});
    const F t = (to_float(plane) * 0.25F - 1 - origin_) * inverse_;
    leave = select((plane <= 0) | (plane >= 8), all_lanes<F>(infinity), t);
  }

  F origin_{}, inverse_{};
  Mask upward_{};
};

template <class F>
struct Run {
  F begin{}, end{};
  ShareLine<F> share{};  // of the range of angles, where patches give it
};

struct NoPatches {};

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
    while (any(open)) {
      const F leave = min_of(min_of(layers_[0].leave, layers_[1].leave), min_of(layers_[2].leave, end_));
      const IntOf<F> layer[3] = {layers_[0].index, layers_[1].index, layers_[2].index};
      const Mask crossed = open & (leave > t_), surface = crossed & slots_.at(layer, crossed);
      const Mask first = surface & !found;
      if constexpr (Rule == Angle::Patched) {
        if (any(surface)) add_shares(ray, surface, first, layer, leave, run);
      }
      assign(first, run.begin, t_);
      assign(surface, run.end, leave);
      const Mask closed = found & crossed & !surface;
      found = found | surface;
      for (Layer<F>& l : layers_) l.step(open & (l.leave <= leave));
      t_ = select(crossed, leave, t_);
      const Mask last = open & (leave >= end_);
      ended_ = ended_ | last;
      open = open & !closed & !last;
    }
    return found;
  }

 private:
  void add_shares(const RayOf<F>& ray, Mask surface, Mask first, const IntOf<F> (&layer)[3], F leave, Run<F>& run) {
    patches_.find(blocks_, ray, surface, layer);
    assign(first, run.share, patches_.line());
    patches_.widen(surface, t_, leave, run.share);
  }

  BlocksOf<F> blocks_;
  SlotBits<F> slots_;
  Layer<F> layers_[3];
  F t_, end_;
  Mask ended_;
  [[no_unique_address]] std::conditional_t<Rule == Angle::Patched, PatchLines<F>, NoPatches> patches_;
};
