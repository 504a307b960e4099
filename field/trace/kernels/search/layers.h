// The layers of a block along an axis that a ray goes through. Part of block_kernels_<set>.cpp.

// Of `Count` layers the one that a ray is in, and where it leaves it. The outer ones go on beyond the block, so that no
// rounding of its faces cuts off the end of a ray.
template <class F, int Count>
class Layer {
 public:
  using Mask = MaskOf<F>;
  using Int = IntOf<F>;

  Layer() = default;
  Layer(F origin, F direction, F t) : origin_(origin), inverse_(1 / nonzero(direction)) {
    onward_ = select(nonzero(direction) > 0.0F, Int{} + 1, Int{} - 1);
    start(origin + direction * t);
  }
  // Of the same ray elsewhere.
  template <int Other>
  Layer(const Layer<F, Other>& same, F direction, F t)
      : origin_(same.origin_), inverse_(same.inverse_), onward_(same.onward_) {
    start(origin_ + direction * t);
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
  template <class, int>
  friend class Layer;

  void start(F place) {
    index = layer_of<Count>(place);
    plane_ = index + ((onward_ + 1) >> 1);
    leave = t_at_plane();
    look_ahead();
  }
  // Planes are one step ahead, so that no step has to wait for a place.
  void look_ahead() {
    plane_ = plane_ + onward_;
    leave_next_ = t_at_plane();
  }
  F t_at_plane() const {
    constexpr float width = 2.0F / Count;
    const F t = (to_float(plane_) * width - 1 - origin_) * inverse_;
    return select((plane_ <= 0) | (plane_ >= Count), all_lanes<F>(infinity), t);
  }

  F origin_{}, inverse_{}, leave_next_{};
  Int onward_{}, plane_{};
};
