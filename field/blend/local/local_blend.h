// A blend in a part of space: what is away from it as weighted points, the rest as it is.
#pragma once

#include <cstddef>
#include <memory>

#include "field/blend/angle/local_contact.h"
#include "field/blend/blend_field.h"
#include "field/blend/bounds/blend_bounds.h"
#include "field/blend/correction/correction.h"
#include "field/blend/local/near_skeletons.h"
#include "field/blend/sources/far_polynomial.h"
#include "field/blend/sources/source_sums.h"
#include "field/math/box3.h"

namespace marrow {

/// The field of a blend inside a box, to within a certified error, summed in a fraction of the time. Integrals
/// under the inverse and the Cauchy kernel become nodes of rules as soon as the box is away from them; those under the
/// compact kernel are left out where they are 0. Boxes inside the box share its nodes and add their own, until many of
/// them are so far away that a polynomial stands for these. A contact angle that adapts to the place is found by sums
/// of the same sources, with the radii of their skeletons as marks, and by the near skeletons. Immutable.
class LocalBlend {
 public:
  /// What each primitive may add to the error of f: this much of its own field, as far as that is below 1; all of them
  /// together this much again. What was measured is below 1e-11.
  static constexpr double largest_error = 1e-7;

  /// `outer` holds a box around this one, or is null. Null, or `outer` itself, when there is nothing to gain.
  /// `blend` must outlive what is made of it.
  static std::shared_ptr<const LocalBlend> make(const BlendField& blend, std::shared_ptr<const LocalBlend> outer,
                                                const Box3& box);

  /// As corrected_value() and evaluate().corrected_gradient of the blend.
  double value(const Vec3d& p) const;
  struct Sample {
    double value;
    Vec3d gradient;
  };
  Sample evaluate(const Vec3d& p) const;
  /// As blend_bounds(), for a box in the box: of this field, whose slopes are those of its sums.
  BlendBounds bounds(const Box3&, Wanted = Wanted::Slopes, const Within& = {}) const;

  /// Primitives, or parts of them, that are still summed as they are but would not be in smaller boxes.
  std::size_t near_count() const;
  /// Whether these take most of the time of a sum.
  bool is_mostly_near() const;
  std::size_t source_count() const;
  /// Certified: by how much f and grad_S f differ from the blend's, at most.
  double f_error() const { return f_error_; }
  double S_error() const { return S_error_; }
  /// Whether a polynomial stands for what is far away.
  bool has_polynomial() const { return last().far_ != nullptr; }
  /// Without what it shares.
  std::size_t bytes() const;

 private:
  LocalBlend(const BlendField&, std::shared_ptr<const LocalBlend> outer);
  /// The one of itself and those around it that stands for all farther out.
  const LocalBlend& last() const;
  void fold_far_sources(const Box3&);
  bool keep_near(const LocalBlend* outer, const Box3&);
  bool is_marked() const;
  /// The sum of what is here and farther out; with marks where there are any.
  template <Derivatives>
  SkeletonSample sum_at(const Vec3d& p, MarkSums&) const;
  Neighbourhood place_at(const Vec3d& p, const SkeletonSample& sum, const MarkSums&) const;
  AlphaSample angle_at(const Vec3d& p, const SkeletonSample& sum, const MarkSums&) const;
  AngleBounds angles_in(const Box3&, const SumBounds&) const;
  template <class Visit>
  void for_each_sums(const Visit& visit) const {
    for (const LocalBlend* here = this; here != nullptr; here = here->outer_.get())
      for (const SourceSums* sums : here->sources_.all())
        if (!sums->empty()) visit(*sums);
  }

  const BlendField& blend_;
  std::shared_ptr<const LocalBlend> outer_;  ///< null: it holds all there is
  Correction correction_;
  BlendField rest_;
  SourceLists sources_;
  std::unique_ptr<const FarPolynomial> far_, far_marks_;
  std::unique_ptr<const NearSkeletons> near_;  ///< where the angle adapts to density
  double reference_radius_;                    ///< of the blend
  double f_error_ = 0, S_error_ = 0;           ///< of all sources, those of outer boxes included
};

}  // namespace marrow
