// The published and the recomputed key angles (Zanni et al. 2015, sec. 5).
#include "field/blend/angle/contact.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "field/blend/blend_field.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

TEST(Contact, HasTheKeyAngles) {
  const double paper[] = {0.93025965372318, 1.1654470907369, 1.2805967045632,
                          1.3459487976559,  1.3875224532524, 1.4161713205957};
  const double exact[] = {0.84188329890419, 1.115852139913, 1.2504549961483};
  for (int n = 3; n <= 8; ++n) EXPECT_NEAR(contact_alpha(n), paper[n - 3], 1e-12) << n;
  for (int n = 3; n <= 5; ++n) EXPECT_NEAR(contact_alpha(n, true, Projection::Exact), exact[n - 3], 1e-12) << n;
}

TEST(Contact, WithoutCavityIsInClosedForm) {
  for (int n = 3; n <= max_kernel_degree; ++n) {
    EXPECT_NEAR(contact_alpha(n, false), atan((n - 1) * pow(2, 1.0 / (n - 1))), 1e-13) << n;
    EXPECT_NEAR(contact_alpha(n, false, Projection::Exact), atan(n - 1), 1e-13) << n;
  }
}

// Two balls join at a little less than contact and are apart at a little more.
TEST(Contact, JoinsTwoBallsWhenTheyTouch) {
  for (int n = 3; n <= max_kernel_degree; ++n) {
    const auto between = [&](double distance) {
      BlendField blend;
      blend.degree = n;
      blend.alpha = contact_alpha(n);
      blend.points.add({{0, 0, 0}, 0.7}, {});
      blend.points.add({{distance, 0, 0}, 0.7}, {});
      return corrected_value(blend, {distance / 2, 0, 0});
    };
    EXPECT_NEAR(between(1.4), 1, 1e-13) << n;
    EXPECT_GT(between(1.39), 1) << n;
    EXPECT_LT(between(1.41), 1) << n;
  }
}

TEST(Contact, AtZeroAngleBallsJoinAtTheDistanceOfTheClosedForm) {
  for (int n = 3; n <= max_kernel_degree; ++n) {
    BlendField blend;
    blend.degree = n;
    blend.alpha = 0;
    const double d = std::sqrt(n) * pow(2 / std::sqrt(n + 1), (n + 1.0) / n);  // as Zanni et al. 2015 print it
    blend.points.add({{0, 0, 0}, 1}, {});
    blend.points.add({{d, 0, 0}, 1}, {});
    EXPECT_NEAR(corrected_value(blend, {d / 2, 0, 0}), 1, 1e-12) << n;
  }
}

// Kernels so wide that the angle at which two would join when they touch leaves nothing of one alone. Their surface may
// lie a little inside.
TEST(Contact, LeavesLoneSkeletonsOfWideKernelsSolid) {
  for (const Kernel& kernel : {Kernel{KernelFamily::Compact, 4, 2.0000001}, Kernel{KernelFamily::Compact, 4, 2.5},
                               Kernel{KernelFamily::Compact, 3, 1.7320509}, Kernel{KernelFamily::Compact, 5, 2.5},
                               Kernel{KernelFamily::Cauchy, 4, 0.49999999}, Kernel{KernelFamily::Cauchy, 3, 0.5}}) {
    BlendField blend;
    blend.kernel = kernel.family;
    blend.degree = kernel.degree;
    blend.kernel_shape = kernel.shape;
    blend.alpha = contact_alpha(kernel);
    blend.points.add({{0, 0, 0}, 0.5}, {});
    SCOPED_TRACE(kernel.shape);
    EXPECT_FALSE(contact_angle(kernel).is_exact);
    for (const double x : {0.0, 0.2, 0.4, 0.48}) EXPECT_GT(corrected_value(blend, {x, 0, 0}), 1) << x;
    EXPECT_LT(corrected_value(blend, {0.5001, 0, 0}), 1);
  }
}

}  // namespace
}  // namespace marrow
