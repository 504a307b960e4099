// The stretches of a ray in slots of a block that may hold surface. Part of block_kernels_<set>.cpp.

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

  Runs(const BlocksOf<F>& blocks, const SlotBits<F>& slots, const Eighths<F>& eighths, const RayOf<F>& ray, F t0, F t1)
      : blocks_(blocks), slots_(slots), eighths_(eighths), t_(t0), end_(t1), ended_(!(t0 < t1)) {
    for (int k = 0; k < 3; ++k) layers_[k] = Slots(ray.origin[k], ray.direction[k], t0);
  }

  // Finds the next run of each of these rays, and tells which have one.
  Mask next(const RayOf<F>& ray, Mask rays, Run<F>& run) {
    Mask found{};
    while (any(rays)) {
      const Mask in_slots = next_in_slots(rays, run), clipped = clip(ray, in_slots, run);
      found = found | clipped;
      rays = in_slots & !clipped;
    }
    if constexpr (Rule == Angle::Patched) assign(found, run.share, line_on(blocks_, ray, found, run.begin, run.end));
    return found;
  }

 private:
  using Slots = Layer<F, 8>;

  Mask next_in_slots(Mask rays, Run<F>& run) {
    Mask found{}, open = rays & !ended_;
    Slots layers[3] = {layers_[0], layers_[1], layers_[2]};  // of its own, for registers
    while (any(open)) {
      const F leave = min_of(min_of(layers[0].leave, layers[1].leave), min_of(layers[2].leave, end_));
      const IntOf<F> layer[3] = {layers[0].index, layers[1].index, layers[2].index};
      const Mask crossed = open & (leave > t_), surface = crossed & slots_.at(slot_address(layer), crossed);
      const Mask first = surface & !found;
      assign(first, run.begin, t_);
      assign(surface, run.end, leave);
      const Mask closed = found & crossed & !surface;
      found = found | surface;
      for (Slots& l : layers) l.step(open & (l.leave <= leave));
      t_ = select(crossed, leave, t_);
      const Mask last = open & (leave >= end_);
      ended_ = ended_ | last;
      open = open & !closed & !last;
    }
    for (int k = 0; k < 3; ++k) layers_[k] = layers[k];
    return found;
  }

  // Stretches from their first eighth on that may hold surface. Returns the rays that come to one.
  Mask clip(const RayOf<F>& ray, Mask rays, Run<F>& run) const {
    if (!eighths_.told()) return rays;
    using Halves = Layer<F, 16>;
    Mask found{}, open = rays;
    F t = run.begin;
    Halves layers[3];
    for (int k = 0; k < 3; ++k) layers[k] = Halves(layers_[k], ray.direction[k], t);
    while (any(open)) {
      const F leave = min_of(min_of(layers[0].leave, layers[1].leave), min_of(layers[2].leave, run.end));
      const IntOf<F> half[3] = {layers[0].index, layers[1].index, layers[2].index};
      const IntOf<F> slot[3] = {half[0] >> 1, half[1] >> 1, half[2] >> 1};
      const Mask crossed = open & (leave > t);
      const IntOf<F> eighths = eighths_.of_slot(slot_address(slot), crossed);
      const Mask surface = crossed & ((eighths >> eighth_address(half) & 1) != 0);
      found = found | surface;
      open = open & !surface & (leave < run.end);
      for (Halves& l : layers) l.step(open & (l.leave <= leave));
      t = select(open & crossed, leave, t);
    }
    assign(found, run.begin, t);
    return found;
  }

  BlocksOf<F> blocks_;
  SlotBits<F> slots_;
  Eighths<F> eighths_;
  Slots layers_[3];
  F t_, end_;
  Mask ended_;
};
