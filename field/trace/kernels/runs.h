// The stretches of a ray in slots of a block that may hold surface. Part of block_kernels_<set>.cpp.

// The bits of a block's 8 x 8 x 8 slots, octant by octant as rays come.
class SlotBits {
 public:
  explicit SlotBits(const BlockView& block) : block_(&block) {}

  // Of the slot in these layers.
  bool at(const int (&layer)[3], bool active) {
    if (active) need(octant_of(layer));
    return bit_of(layer) != 0;
  }
  PacketInt at(const PacketInt (&layer)[3], PacketInt active) {
    const PacketInt octant = octant_of(layer), known = PacketInt{} + static_cast<int>(known_);
    const PacketInt unknown = active & ((known >> octant & 1) == 0);
    for (unsigned left = lane_bits(unknown); left != 0; left &= left - 1) need(octant[__builtin_ctz(left)]);
    return bit_of(layer) != 0;
  }

 private:
  void need(int octant) {
    if (known_ >> octant & 1) return;
    const std::uint64_t slots = block_->surface(octant);
    words_[2 * octant] = static_cast<int>(static_cast<unsigned>(slots));
    words_[2 * octant + 1] = static_cast<int>(static_cast<unsigned>(slots >> 32));
    known_ |= 1U << octant;
  }
  template <class Int>
  static Int octant_of(const Int (&layer)[3]) {
    return (layer[0] >> 2) | (layer[1] >> 2) << 1 | (layer[2] >> 2) << 2;
  }
  template <class Int>
  Int bit_of(const Int (&layer)[3]) const {
    const Int slot = (layer[0] & 3) | (layer[1] & 3) << 2 | (layer[2] & 3) << 4;
    return picked(words_, 2 * octant_of(layer) + (slot >> 5)) >> (slot & 31) & 1;
  }

  const BlockView* block_;
  unsigned known_ = 0;              // a bit for each octant
  alignas(64) int words_[16] = {};  // two for each octant
};

// The layer of a coordinate.
template <class F>
inline IntOf<F> layer_of(F x) {
  constexpr float last = 7.5F;
  return whole_part(max_of(0.0F, min_of(x * 4 + 4, last)));
}

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
};

// From slot to slot along the ray [Amanatides and Woo 1987]; neighbours are joined. Bounds of slots hold a little
// beyond them, by far more than planes and places are rounded. Where the angle goes by patches, a run ends with its
// patch.
template <Angle Rule, class F>
class Runs {
 public:
  using Mask = MaskOf<F>;

  Runs(const BlockView& block, const RayOf<F>& ray, F t0, F t1)
      : block_(&block), slots_(block), t_(t0), end_(t1), ended_(!(t0 < t1)) {
    for (int k = 0; k < 3; ++k) layers_[k] = Layer<F>(ray.origin[k], ray.direction[k], t0);
  }

  // Finds the next run of each of these rays, and tells which have one.
  Mask next(Mask rays, Run<F>& run) {
    Mask found{}, open = rays & !ended_;
    while (any(open)) {
      const F leave = min_of(min_of(layers_[0].leave, layers_[1].leave), min_of(layers_[2].leave, end_));
      const IntOf<F> layer[3] = {layers_[0].index, layers_[1].index, layers_[2].index};
      const Mask crossed = open & (leave > t_), surface = crossed & slots_.at(layer, crossed);
      const Mask first = surface & !found;
      Mask waits{};  // at a slot of another patch
      if constexpr (Rule == Angle::Patched) {
        if (any(first)) patches.find(*block_, first, layer);
        waits = surface & found & !patches.hold(layer);
      }
      assign(first, run.begin, t_);
      assign(surface & !waits, run.end, leave);
      const Mask closed = found & crossed & ((!surface) | waits), moves = open & !waits;
      found = found | surface;
      for (Layer<F>& l : layers_) l.step(moves & (l.leave <= leave));
      t_ = select(crossed & moves, leave, t_);
      const Mask last = moves & (leave >= end_);
      ended_ = ended_ | last;
      open = open & !closed & !last;
    }
    return found;
  }

  Patches<F> patches;  // of the runs that were found last

 private:
  const BlockView* block_;
  SlotBits slots_;
  Layer<F> layers_[3];
  F t_, end_;
  Mask ended_;
};
