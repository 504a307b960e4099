// A blend in a part of space: what is away from it as weighted points, the rest as it is.
#pragma once

#include <cstddef>
#include <memory>

#include "field/blend/blend_bounds.h"
#include "field/blend/blend_field.h"
#include "field/blend/correction.h"
#include "field/blend/source_sums.h"
#include "field/math/box3.h"

namespace marrow {

/// The same field as the blend's inside a box, to within `relative_error`, summed in a fraction of the time. Integrals
/// under the inverse and the Cauchy kernel become nodes of rules as soon as the box is away from them; those under the
/// compact kernel are left out where they are 0. Boxes inside the box share its nodes and add their own. Immutable.
class LocalBlend {
 public:
  /// Error of f, over itself and over 1: as exact as sums of the closed forms themselves need to be.
  static constexpr double relative_error = 1e-10;

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
  /// As blend_bounds(), for a box in the box. The value's hold the blend's values as well.
  BlendBounds bounds(const Box3&) const;

  /// Primitives, or parts of them, that are still summed as they are.
  std::size_t rest_count() const { return rest_.size(); }
  std::size_t source_count() const;
  /// Without what it shares.
  std::size_t bytes() const;

 private:
  LocalBlend(const BlendField&, std::shared_ptr<const LocalBlend> outer);
  friend class SourceMaker;
  template <class Visit>
  void for_each_sums(const Visit& visit) const {
    for (const LocalBlend* here = this; here != nullptr; here = here->outer_.get())
      for (const SourceSums* sums : {&here->points_, &here->curves_, &here->surfaces_})
        if (!sums->empty()) visit(*sums);
  }

  const BlendField& blend_;
  std::shared_ptr<const LocalBlend> outer_;
  Correction correction_;
  BlendField rest_;
  SourceSums points_, curves_, surfaces_;
  double f_error_ = 0, S_error_ = 0;  ///< of all sources, those of outer boxes included
};

}  // namespace marrow
