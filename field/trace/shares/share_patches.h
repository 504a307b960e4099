// The share of the range of angles in the parts of a block, where directions of strands give it.
//
// What strands.h tells of a place is fitted by polynomials, and these are what is traced: their bounds along a ray are
// exact, they cost little, and the coarse level can use lines beside them. The parts are octants of the block, or
// octants of octants, down to 1/128 of its side, where the fit is not good enough, or would not be by what that of the
// larger part is off; each is made when the first ray comes by, and is a function of the block alone.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>

#include "field/trace/kernels/block_kernels.h"
#include "field/trace/kernels/share_part.h"

namespace marrow {

/// Those of one block. Safe to use from many threads.
class SharePatches {
 public:
  SharePatches() = default;
  SharePatches(const SharePatches&) = delete;
  SharePatches& operator=(const SharePatches&) = delete;
  ~SharePatches() { free_all(octants_); }

  /// What strands tell of strand_place of a cube; returns what that may be off.
  using Find = std::function<double(const float (&center)[3], float half, StrandShares&)>;
  /// The part that holds a smallest one, which has a patch. `find` is asked when one is made.
  const SharePart& at(int path, const Find& find) const;

  const SharePart* octants() const { return octants_.parts.data(); }
  static const SharePatch& patch_of(const SharePart& part) { return *patch_at(part.address); }
  /// To a smallest part, given by its layers: from the largest cube to the smallest the octants that hold it.
  static int path_to(const int (&layer)[3]);

  std::size_t bytes() const { return bytes_.load(std::memory_order_relaxed); }
  /// The largest error of any that was made, see SharePatch.
  double error() const { return static_cast<double>(error_.load(std::memory_order_relaxed)); }

 private:
  struct alignas(64) Eight {
    std::array<SharePart, 8> parts;
  };
  static std::uintptr_t address_of(SharePart& part) {
    return std::atomic_ref(part.address).load(std::memory_order_acquire);
  }
  static const SharePatch* patch_at(std::uintptr_t address) { return reinterpret_cast<const SharePatch*>(address); }
  static Eight* parts_at(std::uintptr_t address) { return reinterpret_cast<Eight*>(address - SharePart::divided); }
  static void free_all(const Eight&);

  // These return the address that the part then has. `residual`: SharePart::bent.
  std::uintptr_t divide(float residual, SharePart& to) const;
  // Makes a patch, or divides the part where one does not do.
  std::uintptr_t fit_or_divide(const Find&, int path, int shift, SharePart& to) const;
  // Whether hardly an octant has a patch that does, where that of the whole part is off by so much.
  static bool is_far_off(float residual);
  template <class T>
  std::uintptr_t keep(const SharePart& made, std::unique_ptr<T> owned, SharePart& to) const;

  mutable Eight octants_;
  mutable std::mutex keeping_;
  mutable std::atomic<std::size_t> bytes_ = 0;
  mutable std::atomic<float> error_ = 0;
};

}  // namespace marrow
