// The share of the range of angles in the parts of a block, where directions of strands give it.
//
// What strands.h tells of a place is fitted by polynomials, and these are what is traced: their bounds along a ray are
// exact, they cost little, and the coarse level can use lines beside them. The parts are octants of the block, or
// octants of those down to its slots where the fit is not good enough; each is made when the first ray comes by, and is
// a function of the block alone.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "field/math/vec3.h"
#include "field/trace/block_kernels.h"
#include "field/trace/block_level.h"

namespace marrow {

/// A share, its gradient, and what bounds how it bends: |share(x + v) - share(x) - gradient . v| <= bend |v|^2 within
/// the part. In the coordinates of the block.
struct ShareAt {
  double share = 0;
  Vec3d gradient;
  double bend = 0;
  double error = 0;  ///< as SharePatch::error
};
ShareAt share_at(const SharePatch&, const Vec3d& place);

/// Those of one block. Safe to use from many threads.
class SharePatches {
 public:
  /// The part that holds a slot, given by its layers, 0 to 7. `strands()` is the level of stranded_level.h; it is asked
  /// for when a part is made.
  template <class Strands>
  const SharePatch& at(const int (&layer)[3], const BlockKernels& kernels, int degree, const Strands& strands) const;

  std::size_t bytes() const { return bytes_.load(std::memory_order_relaxed); }
  /// The largest error of any that was made, see SharePatch.
  double error() const { return static_cast<double>(error_.load(std::memory_order_relaxed)); }

 private:
  struct Eight;
  // One of the two.
  struct Made {
    std::unique_ptr<const SharePatch> patch;
    std::unique_ptr<const Eight> parts;  // where a patch does not tell the share well enough
  };
  // Made when it is first asked for, as Lazy is. The lowest bit of its address tells which of the two it is, so that
  // whoever looks for a patch reads nothing of the parts around it.
  class Part {
   public:
    Part() = default;
    Part(const Part&) = delete;
    Part& operator=(const Part&) = delete;
    ~Part();

    template <class Make>
    std::uintptr_t get(const Make& make) const {
      const std::uintptr_t ready = address_.load(std::memory_order_acquire);
      return ready != 0 ? ready : keep(make());
    }

   private:
    std::uintptr_t keep(Made) const;
    mutable std::atomic<std::uintptr_t> address_ = 0;
  };
  struct alignas(64) Eight {
    std::array<Part, 8> parts;
  };
  static constexpr std::uintptr_t divided = 1;
  static const SharePatch* patch_at(std::uintptr_t address) { return reinterpret_cast<const SharePatch*>(address); }
  static const Eight* parts_at(std::uintptr_t address) { return reinterpret_cast<const Eight*>(address - divided); }

  Made make(const BlockKernels&, int degree, const BlockLevel& strands, const int (&layer)[3], int layers_log2) const;

  Eight octants_;
  mutable std::atomic<std::size_t> bytes_ = 0;
  mutable std::atomic<float> error_ = 0;
};

template <class Strands>
const SharePatch& SharePatches::at(const int (&layer)[3], const BlockKernels& kernels, int degree,
                                   const Strands& strands) const {
  const Eight* eight = &octants_;
  for (int log2 = 2;; --log2) {
    const int octant = (layer[0] >> log2 & 1) | (layer[1] >> log2 & 1) << 1 | (layer[2] >> log2 & 1) << 2;
    const std::uintptr_t address = eight->parts[static_cast<std::size_t>(octant)].get(
        [&] { return make(kernels, degree, strands(), layer, log2); });
    if ((address & divided) == 0) return *patch_at(address);
    eight = parts_at(address);
  }
}

}  // namespace marrow
