// The field of a tree for every type of number.
#include "field/blend/curvature.h"
#include "field/tree/machine.h"

namespace marrow {

namespace {

// The machine of a thread, with its stacks; a tree inside a tree (a field that steers the angle of a blend) gets a
// fresh one.
template <Number X>
class BorrowedMachine {
 public:
  BorrowedMachine() : owner_(!is_taken_) { is_taken_ = true; }
  ~BorrowedMachine() {
    if (owner_) is_taken_ = false;
  }
  BorrowedMachine(const BorrowedMachine&) = delete;
  BorrowedMachine& operator=(const BorrowedMachine&) = delete;
  tree::Machine<X, X>& get() { return owner_ ? of_thread_ : fresh_; }

 private:
  static thread_local tree::Machine<X, X> of_thread_;
  static thread_local bool is_taken_;
  bool owner_;
  tree::Machine<X, X> fresh_;
};
template <Number X>
thread_local tree::Machine<X, X> BorrowedMachine<X>::of_thread_;
template <Number X>
thread_local bool BorrowedMachine<X>::is_taken_ = false;

}  // namespace

template <Number X>
X value(const FieldTree& tree, const Vec3<X>& p, std::uint32_t below) {
  BorrowedMachine<X> machine;
  return machine.get().run(tree, below, p, X(0.0),
                           [&](std::uint32_t record, const tree::Place<X>& at, std::span<const X> children) {
                             return tree::value_of_record(tree, tree.records()[record], at, children);
                           });
}

template double value(const FieldTree&, const Vec3<double>&, std::uint32_t);
template Jet<double, 3> value(const FieldTree&, const Vec3<Jet<double, 3>>&, std::uint32_t);
template HessianJet value(const FieldTree&, const Vec3<HessianJet>&, std::uint32_t);
template Interval value(const FieldTree&, const Vec3<Interval>&, std::uint32_t);
template Jet<Interval, 1> value(const FieldTree&, const Vec3<Jet<Interval, 1>>&, std::uint32_t);
template Jet<Interval, 3> value(const FieldTree&, const Vec3<Jet<Interval, 3>>&, std::uint32_t);

namespace tree {

HessianJet blend_value(const BlendField& blend, const Vec3<HessianJet>& p) {
  const HessianJet f = second_order_corrected(blend, {p.x.value, p.y.value, p.z.value});
  HessianJet r(f.value);
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t i = 0; i < 3; ++i) r.slope[i] += f.slope[a] * p[a].slope[i];
    for (std::size_t k = 0; k < 6; ++k) r.curvature[k] += f.slope[a] * p[a].curvature[k];
  }
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [i, j] = HessianJet::at[k];
    for (std::size_t m = 0; m < 6; ++m) {
      const auto [a, b] = HessianJet::at[m];
      r.curvature[k] += f.curvature[m] * p[a].slope[i] * p[b].slope[j];
      if (a != b) r.curvature[k] += f.curvature[m] * p[b].slope[i] * p[a].slope[j];
    }
  }
  return r;
}

}  // namespace tree
}  // namespace marrow
