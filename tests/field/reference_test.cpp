// Against values computed with 40 digits, independently of this code (reference/nary_blend_public.json).
#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "field/blend/blend_field.h"
#include "field/blend/correction/correction.h"
#include "tests/field/random.h"
#include "tests/field/reference_values.h"

namespace marrow {
namespace {

using nlohmann::json;
using test::reference_values;
using test::relative;

Vec3d vector_of(const json& j) { return {j.at(0), j.at(1), j.at(2)}; }

TriangleSkeleton triangle_of(const json& p) {
  const json &v = p.at("v"), &tau = p.at("tau");
  return {{vector_of(v[0]), vector_of(v[1]), vector_of(v[2])}, {tau[0], tau[1], tau[2]}};
}
ArcSkeleton arc_of(const json& p) {
  return {vector_of(p.at("center")),
          vector_of(p.at("e1")),
          vector_of(p.at("e2")),
          p.at("rho"),
          p.at("phi0"),
          p.at("phi1"),
          p.at("tau0"),
          p.at("tau1")};
}

// Nothing when the entry needs a kernel or a primitive that is not built.
std::optional<BlendField> blend_of(const json& entry) {
  const json& kernel = entry.at("kernel");
  BlendField blend;
  if (kernel.at("type") == "cauchy") {
    blend.kernel = KernelFamily::Cauchy;
    blend.kernel_shape = kernel.at("s");
  } else if (kernel.at("type") == "compact") {
    blend.kernel = KernelFamily::Compact;
    blend.kernel_shape = kernel.at("R");
  }
  blend.degree = entry.at("n");
  for (const json& p : entry.at("primitives")) {
    const std::string type = p.at("type");
    if (type == "point") blend.points.add({vector_of(p.at("c")), p.at("tau")}, {});
    else if (type == "segment" || type == "distance_segment")
      (type == "segment" ? blend.segments : blend.distance_segments)
          .add({vector_of(p.at("a")), vector_of(p.at("b")), p.at("tau_a"), p.at("tau_b")}, {});
    else if (type == "triangle") blend.triangles.add(triangle_of(p), {});
    else if (type == "circle" || type == "arc") blend.arcs.add(arc_of(p), {});
    else return {};
  }
  return blend;
}

double operator_value(const json& corrected, const std::string& name, int n, double f, double G) {
  const bool cavity = name.ends_with("_cav"), exact = name.starts_with("exact");
  const double alpha = corrected.at("alpha");
  return Correction(n, alpha, cavity, exact ? Projection::Exact : Projection::Paper).value(f, G);
}

// With G = 0 and alpha = 0 the exact projection is 0, where the oracle's Newton iteration stops near 1e-78.
double operator_error(double value, double expected) {
  return std::max(std::fabs(value), std::fabs(expected)) < 1e-60 ? 0 : relative(value, expected);
}

// 1e-11; nearer to a skeleton the offset from it has lost digits, 5e-12 there.
double field_tolerance(const std::string& tag) { return tag == "segment_near_skeleton" ? 5e-12 : 1e-11; }

TEST(Reference, FieldsAndGradients) {
  std::map<std::string, double> worst;
  std::map<std::string, int> not_of_this_build;
  int checked = 0;
  for (const json& entry : reference_values().at("fields")) {
    const std::string tag = entry.at("tag");
    const auto blend = blend_of(entry);
    if (!blend) {
      ++not_of_this_build[tag];
      continue;
    }
    ++checked;
    const auto s = sum_of_primitives<Derivatives::Second>(*blend, vector_of(entry.at("point")));
    const double error = std::max({relative(s.value, entry.at("f")), relative(s.gradient, vector_of(entry.at("grad"))),
                                   relative(s.si_gradient, vector_of(entry.at("si_grad")))});
    worst[tag] = std::max(worst[tag], error);
    EXPECT_LE(error, field_tolerance(tag)) << entry.at("id") << ' ' << tag;
  }
  for (const auto& [tag, error] : worst) std::cout << "  " << tag << ": worst relative error " << error << '\n';
  int waiting = 0;
  for (const auto& [tag, count] : not_of_this_build) {
    std::cout << "  not of this build: " << tag << " (" << count << ")\n";
    waiting += count;
  }
  EXPECT_EQ(checked, 260);
  EXPECT_EQ(waiting, 0);
}

// Points at distance 1 with the fields of the entry.
TEST(Reference, AlphaPerSkeleton) {
  int checked = 0;
  double worst = 0;
  for (const json& entry : reference_values().at("alpha")) {
    BlendField blend;
    blend.degree = 3;
    blend.alpha_per_skeleton = true;
    for (std::size_t i = 0; i < entry.at("f").size(); ++i) {
      blend.points.add({{1, 0, 0}, std::sqrt(entry.at("f")[i].get<double>())}, {});
      blend.points.alphas.push_back(entry.at("alpha_i")[i]);
    }
    const double error = std::fabs(alpha_at(blend, {0, 0, 0}).value - entry.at("alpha_eq14").get<double>());
    EXPECT_LE(error, 1e-13) << entry.at("id");
    worst = std::max(worst, error);
    ++checked;
  }
  std::cout << "  " << checked << " values, worst error " << worst << '\n';
  EXPECT_EQ(checked, 40);
}

TEST(Reference, AlphaByDirection) {
  int checked = 0;
  double worst = 0;
  for (const json& entry : reference_values().at("alpha")) {
    std::vector<Strand> strands;
    for (std::size_t i = 0; i < entry.at("f").size(); ++i)
      strands.push_back({.field = entry.at("f")[i],
                         .field_gradient = {},
                         .direction = vector_of(entry.at("u")[i]),
                         .direction_jacobian = {},
                         .bounds = {entry.at("alpha_min"), entry.at("alpha_max")}});
    const double error = std::fabs(directional_alpha(strands, false).value - entry.at("alpha_eq15").get<double>());
    EXPECT_LE(error, 1e-13) << entry.at("id");
    worst = std::max(worst, error);
    ++checked;
  }
  std::cout << "  " << checked << " values, worst error " << worst << '\n';
  EXPECT_EQ(checked, 40);
}

TEST(Reference, CorrectedFields) {
  int checked = 0;
  double worst = 0;
  for (const json& entry : reference_values().at("fields")) {
    const auto blend = blend_of(entry);
    if (!blend || !entry.contains("corrected")) continue;
    const auto s = sum_of_primitives<Derivatives::ScaleInvariant>(*blend, vector_of(entry.at("point")));
    for (const json& corrected : entry.at("corrected"))
      for (const char* name : {"eq12", "eq12_cav", "exact", "exact_cav"}) {
        if (!corrected.contains(name)) continue;
        const double value = operator_value(corrected, name, blend->degree, s.value, length(s.si_gradient));
        const double error = relative(value, corrected.at(name));
        EXPECT_LE(error, 1e-11) << entry.at("id") << ' ' << name << " alpha " << corrected.at("alpha");
        worst = std::max(worst, error);
        ++checked;
      }
  }
  std::cout << "  " << checked << " values, worst relative error " << worst << '\n';
  EXPECT_GT(checked, 3000);
}

TEST(Reference, Operator) {
  int checked = 0, guarded = 0;
  double worst = 0;
  for (const json& entry : reference_values().at("operator")) {
    const int n = entry.at("n");
    const double f = entry.at("f"), G = entry.at("G");
    for (const json& corrected : entry.at("corrected")) {
      for (const char* name : {"eq12", "eq12_cav", "exact", "exact_cav"}) {
        if (!corrected.contains(name)) continue;
        const double error = operator_error(operator_value(corrected, name, n, f, G), corrected.at(name));
        EXPECT_LE(error, 1e-12) << entry.at("id") << ' ' << name << " alpha " << corrected.at("alpha") << " f " << f
                                << " G " << G;
        worst = std::max(worst, error);
        ++checked;
      }
      guarded += corrected.value("guard_active", false);
      const double alpha = corrected.at("alpha");
      const Correction with_cavity(n, alpha, true, Projection::Paper);
      if (!with_cavity.is_sum()) {
        EXPECT_EQ(with_cavity.in_cavity_branch(f, G), corrected.at("cav_branch").get<bool>())
            << entry.at("id") << " alpha " << alpha;
      }
    }
  }
  std::cout << "  " << checked << " values, " << guarded << " guarded, worst relative error " << worst << '\n';
  EXPECT_GT(checked, 4000);
  EXPECT_GT(guarded, 10);
}

}  // namespace
}  // namespace marrow
