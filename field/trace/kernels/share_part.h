// What kernels read of the share of the range of angles, in the coordinates of a block: share_patches.h makes it.
#pragma once

#include <cstdint>

namespace marrow {

/// The share of the range of angles in a part of a block, where directions give it: a polynomial in (x - center) /
/// half, its coefficients in the order of far_field.h. It is the share that is traced; see share_patches.h.
struct alignas(64) SharePatch {
  static constexpr int degree = 4, coefficients = 35;  ///< binom(degree + 3, 3)
  float center[3] = {0, 0, 0}, inverse_half = 1;
  float error = 0;  ///< what it may be off from the exact share: an estimate
  float bend = 0;   ///< half of its second derivative along any line is at most this
  float coefficient[coefficients] = {};
};
inline constexpr int floats_per_patch = sizeof(SharePatch) / sizeof(float);

/// A part of a block, for which there is one patch, or eight smaller parts: an octant of the block, of one of those,
/// and so on to 1/128 of its side: blocks may be as large as 12 radii. Parts of one cube follow each other by their
/// octants, x the lowest bit. What runs need of a patch is here, so that they find it where they find out that there is
/// one.
struct alignas(32) SharePart {
  /// Of the patch; one more than that of the first of eight parts; or 0 where neither is made yet. The rest may be
  /// read once this is set; of eight parts only `bent` means anything.
  std::uintptr_t address = 0;
  float half = 0.5F;  ///< of the part
  float level = 0;    ///< in the part the share is within `bent` of level + slope . (x - center)
  float slope[3] = {0, 0, 0};
  float bent = 0;  ///< of eight parts: what one patch would be off, 0 where none was tried

  static constexpr std::uintptr_t divided = 1;
  /// From the block to the smallest parts, of which there are so many along each axis.
  static constexpr int halvings = 7, layers = 1 << halvings;
  /// Of the first octant of a path to a smallest part: the octants that hold it, the largest cube's in the highest
  /// bits.
  static constexpr int root_shift = 3 * (halvings - 1);
};

}  // namespace marrow
