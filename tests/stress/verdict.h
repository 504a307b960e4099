// What rays found, held against the exact field.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tests/stress/stress_scene.h"

namespace marrow::test {

/// Counts add up; largest values too.
struct Verdict {
  std::uint64_t rays = 0, hits = 0;
  /// A stretch inside was skipped, with a corrected field above 1 + StressScene::grazing_excess() on it, and the answer
  /// said that nothing was.
  std::uint64_t missed = 0;
  /// The same, but the answer said that a gap before it was not decided.
  std::uint64_t lost = 0;
  /// A hit off the surface, where the exact field differs from 1 by more than StressScene::grazing_excess().
  std::uint64_t phantom = 0;
  /// Those of them where it differs by more than far_off.
  std::uint64_t far_phantom = 0;
  /// The start of a further ray that the exact field says is inside.
  std::uint64_t wrong_side = 0;
  /// A hit that is not the same, or not gone, when the ray ends at it, or just before it; or occluded() differs from
  /// first_hit() for rays that end 4 ulp of float behind it, or before it.
  std::uint64_t limits = 0;
  /// The answer is another one without a record, or in company.
  std::uint64_t unlike = 0;
  std::uint64_t in_company = 0;  ///< rays that were asked side by side; not among `rays`
  /// A hit off the surface by more than allowed_displacement, where the field is so flat that it is nearly 1 all the
  /// same.
  std::uint64_t displaced = 0;
  /// A stretch inside was skipped, but the field stays below 1 + StressScene::grazing_excess() on it. Where it stays
  /// below half of that excess a proof of it mostly comes first, and nothing is counted.
  std::uint64_t grazing = 0;
  /// A hit at the point of a cone of radius 0.
  std::uint64_t points = 0;
  /// A ray that says itself that a gap stayed undecided.
  std::uint64_t uncertified = 0;
  /// Hits of camera rays that meet the surface at more than a grazing angle, and those of them whose t is within 4 ulp
  /// of float of the exact root's.
  std::uint64_t measured = 0, within_4_ulp = 0;
  /// Those whose t the rounding of a sum in float moves by less than 4 ulp.
  std::uint64_t conditioned = 0, conditioned_within_4_ulp = 0;
  std::uint64_t evaluations = 0;
  double largest_displacement = 0;  ///< over the distance to the skeleton, of hits that are not counted above
  double largest_ulps = 0;
  std::vector<std::string> missed_rays, lost_rays, phantom_rays, wrong_side_rays,
      limit_rays;  ///< the first few of each, to be traced again

  void add(const Verdict&);
};

/// No phantom at all may be this far off.
inline constexpr double far_off = 5e-5;
/// Allowed distance of a hit from the exact surface, over the distance to the skeleton.
inline constexpr double allowed_displacement = 2e-5;

/// Traces the ray and judges the answer. Every stretch before the hit, or the whole ray, is proved to be outside from
/// exact values (WayProof, or else the certified steps of Oracle), except stretches shorter than 1e-6 of the distance
/// to the skeleton.
/// `from_afar`: the ray begins a camera's distance away, so that ulps of t mean something.
void judge(const StressScene&, const Ray&, const char* family, bool from_afar, Verdict&);

/// Rays that are asked side by side are to get what each gets alone, records and all; counted as rays that are not, if
/// they do not.
void judge_company(const StressScene&, std::span<const Ray>, Verdict&);

/// A line through the scene, traced from both ends and, between the first and the last hit, both ways from places that
/// the exact field says are outside.
struct Parity {
  std::uint64_t lines = 0, crossed = 0, restarts = 0;
  /// One way found surface where the other found none and said that it is certified; more than
  /// StressScene::grazing_excess() deep.
  std::uint64_t odd = 0;
  /// The same, but the ray that found none says that a gap was not decided.
  std::uint64_t odd_lost = 0;
  /// One way found surface that is at most StressScene::grazing_excess() deep.
  std::uint64_t odd_grazing = 0;
  /// One way found nothing but the point of a cone of radius 0.
  std::uint64_t points = 0;
  std::vector<std::string> odd_rays, lost_rays;

  void add(const Parity&);
};
void count_crossings(const StressScene&, const Ray&, Random&, const char* family, Parity&);

}  // namespace marrow::test
