// What rays found in a scene of a general tree, held against samples of the exact field.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/stress/tree_rays.h"

namespace marrow::test {

/// Counts add up.
struct TreeVerdict {
  std::uint64_t rays = 0, hits = 0;
  /// A change of side was skipped, the field beyond it differs from 1 by more than TreeScene::noticed(), and the answer
  /// said that nothing was.
  std::uint64_t missed = 0;
  /// The same, but the answer said that a gap before it was not decided.
  std::uint64_t lost = 0;
  /// A hit where the field differs from 1 by more than that, and does not change sides nearby.
  std::uint64_t phantom = 0;
  /// The start of further rays is inside.
  std::uint64_t wrong_side = 0;
  /// A hit that is not the same, or not gone, when the ray ends at it, or just before it; or occluded() differs.
  std::uint64_t limits = 0;
  /// A change of side was skipped, or a hit is none, but the field stays within it.
  std::uint64_t grazing = 0;
  /// The answer says itself that a gap stayed undecided.
  std::uint64_t uncertified = 0;
  /// Too many samples to judge all of the way.
  std::uint64_t unjudged = 0;
  /// Hits from afar at no grazing angle, whose t the error of a sum moves by less than 4 ulp of float, and those of
  /// them whose t is within 4 ulp.
  std::uint64_t conditioned = 0, within_4_ulp = 0;
  std::uint64_t evaluations = 0;
  /// Lines that met surface, traced both ways and from places between; those where one way found surface that the other
  /// says is certainly not there, or does not know of.
  std::uint64_t lines = 0, odd = 0, odd_lost = 0;
  std::vector<std::string> offenders;  ///< the first few, to be traced again

  void add(const TreeVerdict&);
};

/// `from_afar`: the ray begins a camera's distance away, so that ulps of t mean something.
void judge(const TreeScene&, const AimedRay&, const char* family, bool from_afar, TreeVerdict&);

/// Traces a line from both ends and from places on it that are outside.
void judge_line(const TreeScene&, const AimedRay&, Random&, const char* family, TreeVerdict&);

}  // namespace marrow::test
