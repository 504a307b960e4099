#include "field/trace/shares/share_patches.h"

#include <algorithm>

#include "field/trace/shares/share_bounds.h"
#include "field/trace/shares/share_fit.h"

namespace marrow {
namespace {

// What a patch that is divided no further may be off, by the residuals of its fit. Where they are below it, the share
// was off by 3e-5 at most in 4000 hits of hair and of a creature, by 5e-6 in the median.
constexpr double largest_residual = 4e-5;
// At half the size a patch is off by 2^5 times less, as what it leaves out is of the fifth degree, and seldom by more
// than twice that. Where a part is off by more, 97 of 100 octants could not do with a patch (10,000 hairs; of 867 limbs
// 99).
constexpr double residual_ratio = 64;

struct Cube {
  float center[3], half;
};
// The part that holds the smallest one of a path, by the highest bits of it.
Cube cube_of(int path, int shift) {
  Cube cube{.center = {0, 0, 0}, .half = 1};
  for (int s = SharePart::root_shift; s >= shift; s -= 3) {
    cube.half *= 0.5F;
    for (int k = 0; k < 3; ++k) cube.center[k] += (path >> s >> k & 1) != 0 ? cube.half : -cube.half;
  }
  return cube;
}

}  // namespace

void SharePatches::free_all(const Eight& eight) {
  for (const SharePart& part : eight.parts) {
    if (part.address == 0) continue;
    if ((part.address & SharePart::divided) == 0) {
      delete patch_at(part.address);
    } else {
      free_all(*parts_at(part.address));
      delete parts_at(part.address);
    }
  }
}

int SharePatches::path_to(const int (&layer)[3]) {
  int path = 0;
  for (int log2 = SharePart::halvings - 1; log2 >= 0; --log2)
    for (int k = 2; k >= 0; --k) path = path << 1 | (layer[k] >> log2 & 1);
  return path;
}

bool SharePatches::is_far_off(float residual) {
  return static_cast<double>(residual) > residual_ratio * largest_residual;
}

std::uintptr_t SharePatches::divide(float residual, SharePart& to) const {
  static_assert(alignof(SharePatch) > SharePart::divided && alignof(Eight) > SharePart::divided);
  auto parts = std::make_unique<Eight>();
  SharePart part{.address = reinterpret_cast<std::uintptr_t>(parts.get()) + SharePart::divided, .bent = residual};
  return keep(part, std::move(parts), to);
}

const SharePart& SharePatches::at(int path, const Find& find) const {
  Eight* eight = &octants_;
  float off = 0;  // of the part around
  for (int shift = SharePart::root_shift;; shift -= 3) {
    SharePart& part = eight->parts[static_cast<std::size_t>(path >> shift & 7)];
    std::uintptr_t address = address_of(part);
    if (address == 0) address = shift > 0 && is_far_off(off) ? divide(0, part) : fit_or_divide(find, path, shift, part);
    if ((address & SharePart::divided) == 0) return part;
    eight = parts_at(address);
    off = part.bent;
  }
}

std::uintptr_t SharePatches::fit_or_divide(const Find& find, int path, int shift, SharePart& to) const {
  auto made = std::make_unique<SharePatch>();
  SharePatch& patch = *made;
  const Cube cube = cube_of(path, shift);
  patch.inverse_half = 1 / cube.half;
  for (int k = 0; k < 3; ++k) patch.center[k] = cube.center[k];
  StrandShares shares;
  const double error = find(patch.center, cube.half, shares), residual = fit_share(shares, patch);
  if (shift > 0 && residual > largest_residual) return divide(static_cast<float>(residual), to);
  patch.error = static_cast<float>(error + 2 * residual);  // it is off by more between places
  SharePart part{.address = reinterpret_cast<std::uintptr_t>(made.get()), .half = cube.half};
  set_line(patch, part);
  patch.bend = bend_of(patch);
  for (float known = error_.load(std::memory_order_relaxed);
       known < patch.error && !error_.compare_exchange_weak(known, patch.error, std::memory_order_relaxed);) {}
  return keep(part, std::move(made), to);
}

// Two threads may both have made it; one copy is kept.
template <class T>
std::uintptr_t SharePatches::keep(const SharePart& made, std::unique_ptr<T> owned, SharePart& to) const {
  const std::lock_guard lock(keeping_);
  if (to.address != 0) return to.address;
  bytes_.fetch_add(sizeof(T), std::memory_order_relaxed);
  owned.release();
  to.half = made.half;
  to.level = made.level;
  std::ranges::copy(made.slope, to.slope);
  to.bent = made.bent;
  std::atomic_ref(to.address).store(made.address, std::memory_order_release);
  return made.address;
}

}  // namespace marrow
