// Precise contact: reference values of the bulges, their conditions, what contact guarantees.
#include "field/tree/nodes/contact.h"

#include <limits>

#include <nlohmann/json.hpp>

#include "tests/field/reference_values.h"
#include "tests/tree/node_laws.h"

namespace marrow {
namespace {

using nlohmann::json;
using test::field_of;

const std::vector<Bulge> bulges{PlainBulge{},
                                HeightBulge{},
                                RippleBulge{},
                                PlainBulge{.from = 0.1},
                                HeightBulge{.from = 0.2, .at = 0.9, .height = 0.7},
                                RippleBulge{.from = 0.5, .height = 0.1, .ripples = 4}};

// Scaled to a surface at 1.
TEST(Contact, ReferenceValues) {
  int checked = 0;
  for (const json& e : test::reference_values().at("older_papers")) {
    if (e.at("what") != "pcm_bulge_corrected") continue;
    ++checked;
    const double iso = e.at("iso"), t = double(e.at("f_j")) / iso, c = double(e.at("c")) / iso,
                 m = double(e.at("m")) / iso, h = double(e.at("h")) / iso;
    const auto value = [&](const Bulge& b) { return iso * contact_term(b, t); };
    EXPECT_NEAR(value(PlainBulge{c}), e.at("b1"), 1e-13) << e.at("id");
    EXPECT_NEAR(value(HeightBulge{c, m, h}), e.at("b2"), 1e-13) << e.at("id");
    EXPECT_NEAR(value(RippleBulge{c, h, e.at("ripples")}), e.at("b3"), 1e-12) << e.at("id");
  }
  EXPECT_EQ(checked, 40);
}

TEST(Contact, TermMeetsTheFourConditions) {
  using test::Slope;
  for (const Bulge& b : bulges) {
    EXPECT_EQ(std::visit([](const auto& x) { return x.problem(); }, b), "");
    const double from = std::visit([](const auto&x) { return x.from; }, b), near = 1e-9;
    const auto at = [&](double t) { return contact_term(b, Slope::variable(t, 0)); };
    EXPECT_EQ(at(from - near).value, 0);
    EXPECT_NEAR(at(from + near).value, 0, 1e-12);
    EXPECT_NEAR(at(from + near).slope[0], 0, 1e-6);
    EXPECT_NEAR(at(1 - near).value, 0, 2e-9);
    EXPECT_NEAR(at(1 - near).slope[0], -1, 1e-6);
    EXPECT_EQ(at(1.5).value, -0.5);
    double most = 0;
    for (double t = 0; t < 1; t += 1e-4) {
      EXPECT_GE(at(t).value, 0);
      most = std::max(most, at(t).value);
    }
    EXPECT_LT(most, 1);
    if (const auto* h = std::get_if<HeightBulge>(&b)) { EXPECT_NEAR(most, h->height, 1e-6); }
    if (const auto* h = std::get_if<RippleBulge>(&b)) { EXPECT_NEAR(most, h->height, 1e-5); }
  }
}

// Any number of bodies: deformed ones touch where the two largest fields are equal, and do not overlap.
TEST(Contact, BodiesTouchExactly) {
  test::Random random(5);
  for (int i = 0; i < 2000; ++i) {
    std::vector<double> f{random.between(0, 3), random.between(0, 3), random.between(0, 3), random.between(0, 3)};
    const Contact whole{bulges[static_cast<std::size_t>(i) % bulges.size()], false};
    const Contact one{whole.bulge, true};
    int inside = 0;
    double most = 0;
    for (std::size_t k = 0; k < f.size(); ++k) {
      std::vector<double> mine = f;
      std::swap(mine[0], mine[k]);
      const double deformed = field_of(one, mine);
      inside += deformed > 1;
      most = std::max(most, deformed);
    }
    const double largest = *std::max_element(f.begin(), f.end());
    EXPECT_NEAR(field_of(whole, f), most, 1e-12);
    EXPECT_EQ(inside >= 1, most > 1);
    if (largest > 1) { EXPECT_EQ(inside, 1) << "seed 5 round " << i; }
    f[1] = f[0] = 1 + random.between(0, 3);
    f[2] = f[3] = 0.2;
    EXPECT_NEAR(field_of(one, f), 1, 1e-12);
  }
}

// A bulge has the colour of its body, also where it is steep, and the other body's field rises faster than its own.
TEST(Contact, BelongsToTheBodyWhoseDeformedFieldIsLargest) {
  test::Random random(6);
  for (int i = 0; i < 2000; ++i) {
    std::vector<double> f{random.between(0, 2), random.between(0, 2), random.between(0, 2)};
    const Contact whole{bulges[static_cast<std::size_t>(i) % bulges.size()], false};
    const std::size_t owner = whole.owner(std::span<const double>(f));
    const double value = field_of(whole, f);
    std::swap(f[0], f[owner]);
    EXPECT_NEAR(field_of(Contact{whole.bulge, true}, f), value, 1e-12) << "seed 6 round " << i;
  }
  // on the bulge of the first, where the second contributes more: 0.5 * 1.44 against 0.676
  const Contact steep{HeightBulge{.from = 0.2, .at = 0.7, .height = 0.5}, false};
  const double f[] = {0.676, 0.5};
  EXPECT_NEAR(field_of(steep, {f[0], f[1]}), 1, 1e-3);
  EXPECT_EQ(steep.owner(f), 0u);
}

// Those of the paper's figure do not pass through each other: b' < 1 on the inner flank.
TEST(Contact, UsualBulgesMeetBetweenTheBodies) {
  for (const Bulge& b : {Bulge(PlainBulge{}), Bulge(HeightBulge{})})
    for (double t = 0; t < 1; t += 1e-3) EXPECT_LT(contact_term(b, test::Slope::variable(t, 0)).slope[0], 1);
}

// At a node of two bodies, and close to it, where one more is lost beside fields of 1e30.
TEST(Contact, IsInsideWhereFieldsAreInfinite) {
  const double inf = std::numeric_limits<double>::infinity();
  for (const bool first_only : {false, true}) {
    const Contact contact{PlainBulge{}, first_only};
    EXPECT_EQ(field_of(contact, {inf, inf}), inf);
    EXPECT_EQ(field_of(contact, {inf, inf, inf}), inf);
    EXPECT_EQ(field_of(contact, {inf, 5}), inf);
    EXPECT_EQ(field_of(contact, {1e30, 1e30}), 1);
    EXPECT_GT(field_of(contact, {1e30, 0.9e30}), 1e28);
  }
  EXPECT_EQ(field_of(Contact{}, {5, inf}), inf);
  EXPECT_EQ(field_of(Contact{PlainBulge{}, true}, {5, inf}), 0);
  const Interval whole[] = {{1, inf}, {2, inf}};
  const Interval value = Contact{}.value(std::span<const Interval>(whole));
  EXPECT_LE(value.lo, 1);
  EXPECT_EQ(value.hi, inf);
}

TEST(Contact, FarBodiesStayAsTheyAre) {
  const Contact one{PlainBulge{0.4}, true};
  EXPECT_EQ(field_of(one, {0.7, 0.4, 0.1}), 0.7);
  EXPECT_GT(field_of(one, {0.7, 0.8, 0.1}), 0.7);
  EXPECT_EQ(field_of(one, {0.7, 3, 0.1}), 0);
}

TEST(Contact, Laws) {
  for (const Bulge& b : bulges) {
    for (const bool first : {false, true}) test::expect_lawful_operator(Contact{b, first}, 4, 11, 3);
    test::expect_child_level(Contact{b, false}, 4, 12);
    test::expect_child_level(Contact{b, true}, 4, 13);
  }
}

TEST(Contact, RefusesBulgesThatAreNotHighest) {
  EXPECT_NE(Contact({HeightBulge{.from = 0.4, .at = 0.5, .height = 0.1}}).problem(2), "");
  EXPECT_NE(Contact({HeightBulge{.from = 0.6, .at = 0.5, .height = 0.9}}).problem(2), "");
  EXPECT_NE(Contact({RippleBulge{.from = 0.1, .height = 0.01, .ripples = 1}}).problem(2), "");
  EXPECT_EQ(Contact{}.problem(2), "");
}

}  // namespace
}  // namespace marrow
