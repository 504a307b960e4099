// From description to program: transforms, flattening, and what is refused.
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "field/blend/angle/contact.h"
#include "field/program/field_program.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::numeric_gradient;
using test::Random;
using test::relative;
using testing::HasSubstr;

Primitive primitive(auto skeleton, MaterialId material = {}) {
  Primitive p;
  p.skeleton = std::move(skeleton);
  p.material = material;
  return p;
}

// Builds descriptions; the line of a node's place is its number of children before it plus one.
class Builder {
 public:
  FieldNodeId add(auto what) {
    const int line = static_cast<int>(description_.nodes.size()) + 1;
    return description_.root = description_.add({.what = std::move(what), .where = {"scene.yaml", line, 3}});
  }
  FieldNodeId point(const Vec3d& at, double radius) { return add(primitive(PointSkeleton{at, radius})); }
  FieldNodeId segment(const SegmentSkeleton& s) { return add(primitive(s)); }
  FieldNodeId blend(std::vector<FieldNodeId> of) {
    Blend blend;
    blend.of = std::move(of);
    return add(blend);
  }
  FieldNodeId place(const Affine& map, FieldNodeId of) { return add(Transform{map, of}); }
  const FieldDescription& description() const { return description_; }

 private:
  FieldDescription description_;
};

Affine some_similarity() {
  return Affine::translate({1, -2, 0.5}) * Affine::rotate(normalize({1, 2, 3}), 0.7) * Affine::scale({2.5, 2.5, 2.5});
}
Affine some_affine() { return Affine::translate({0.3, 0, 1}) * Affine::scale({1, 2, 0.5}) * some_similarity(); }

FieldProgram compiled(const FieldDescription& description) {
  auto result = compile(description);
  if (!result) throw std::runtime_error(result.why().front().message);
  return *result;
}

Diagnostics errors(const Builder& builder) {
  const auto result = compile(builder.description());
  return result ? Diagnostics{} : result.why();
}

TEST(Compile, ABarePrimitiveIsABlendOfItselfWithDefaults) {
  Builder builder;
  builder.point({1, 0, 0}, 0.5);
  const FieldProgram program = compiled(builder.description());
  ASSERT_TRUE(is_single_blend(program));
  EXPECT_EQ(program.parts()[0].blend.degree, 4);
  EXPECT_EQ(program.parts()[0].blend.alpha, contact_alpha(4));
  EXPECT_NEAR(value(program, {1, 0.5, 0}), FieldProgram::iso(), 1e-14);
}

TEST(Compile, SimilaritiesAreBakedAndOtherMapsKept) {
  Random random(41);
  for (const auto& [map, baked] : {std::pair{some_similarity(), true}, std::pair{some_affine(), false}}) {
    Builder plain;
    plain.blend({plain.point({0, 0, 0}, 0.8), plain.segment({{0, 0, 0}, {1, 1, 0}, 0.5, 0.3})});
    Builder placed = plain;
    placed.place(map, placed.description().root);
    const FieldProgram local = compiled(plain.description()), world = compiled(placed.description());
    EXPECT_EQ(world.parts()[0].is_in_world(), baked);
    for (int i = 0; i < 50; ++i) {
      const Vec3d p = random.vector(1.5), q = map.point(p);
      EXPECT_LE(relative(value(world, q), value(local, p)), 1e-11);
      const FieldSample s = evaluate(world, q);
      if (s.value > 20) continue;
      const auto field = [&](const Vec3d& x) { return value(world, x); };
      EXPECT_LE(length(numeric_gradient(field, q, 1e-4) - s.gradient), 1e-5 * length(s.gradient) + 1e-8);
    }
  }
}

TEST(Compile, TransformsInsideABlendMapItsPrimitives) {
  Builder inside, above;
  inside.blend({inside.place(some_similarity(), inside.segment({{0, 0, 0}, {1, 1, 0}, 0.5, 0.3}))});
  above.place(some_similarity(), above.blend({above.segment({{0, 0, 0}, {1, 1, 0}, 0.5, 0.3})}));
  EXPECT_EQ(compiled(inside.description()).parts()[0].blend.segments.skeletons,
            compiled(above.description()).parts()[0].blend.segments.skeletons);
}

TEST(Compile, TransformsDistributeOverUnions) {
  Builder builder;
  const auto a = builder.blend({builder.point({0, 0, 0}, 1)});
  const auto b = builder.place(Affine::translate({5, 0, 0}), a);
  builder.place(some_affine(), builder.add(Union{{a, b, builder.point({0, 9, 0}, 0.5)}}));
  const FieldProgram program = compiled(builder.description());
  ASSERT_EQ(program.parts().size(), 3u);
  for (const Vec3d& center : {Vec3d{0, 0, 0}, Vec3d{5, 0, 0}, Vec3d{0, 9, 0}})
    EXPECT_GT(value(program, some_affine().point(center + Vec3d{0.1, 0, 0})), 1);
}

// Wherever it is placed, and in whatever order.
TEST(Compile, ABlendTakesTheSkeletonsOfAGroupAsItsOwn) {
  const SegmentSkeleton limb{{0, 0, 0}, {1, 1, 0}, 0.5, 0.3};
  Builder grouped, listed;
  const auto pair = grouped.add(Union{{grouped.segment(limb), grouped.point({2, 0, 0}, 1)}, true});
  grouped.blend({grouped.place(some_similarity(), pair), grouped.add(Union{{pair}, true})});
  const auto segment = listed.segment(limb), point = listed.point({2, 0, 0}, 1);
  listed.blend({listed.place(some_similarity(), segment), listed.place(some_similarity(), point), segment, point});
  const FieldProgram a = compiled(grouped.description()), b = compiled(listed.description());
  EXPECT_EQ(a.parts()[0].blend.segments.skeletons, b.parts()[0].blend.segments.skeletons);
  EXPECT_EQ(a.parts()[0].blend.points.skeletons, b.parts()[0].blend.points.skeletons);
  EXPECT_EQ(a.parts()[0].blend.size(), 4u);
}

TEST(Compile, AGroupOutsideABlendIsAUnion) {
  Builder grouped, united;
  grouped.add(Union{{grouped.blend({grouped.point({0, 0, 0}, 1)}), grouped.point({2, 0, 0}, 1)}, true});
  united.add(Union{{united.blend({united.point({0, 0, 0}, 1)}), united.point({2, 0, 0}, 1)}});
  const FieldProgram a = compiled(grouped.description()), b = compiled(united.description());
  for (const Vec3d& p : {Vec3d{0.3, 0.4, 0.5}, Vec3d{1.9, 0.1, 0.4}}) EXPECT_EQ(value(a, p), value(b, p));
}

TEST(Compile, LeavesABlendThatIsPlacedManyTimesInItsOwnCoordinates) {
  Builder many, once;
  const auto a = many.blend({many.segment({{0, 0, 0}, {1, 1, 0}, 0.5, 0.3})});
  const auto alone = many.blend({many.point({0, 9, 0}, 0.5)});
  many.add(Union{{many.place(Affine::translate({5, 0, 0}), a), many.place(some_similarity(), a), alone}});
  const FieldProgram program = compiled(many.description());
  const auto parts = program.parts();
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_NE(parts[0].shape, 0u);
  EXPECT_EQ(parts[0].shape, parts[1].shape);
  EXPECT_EQ(parts[2].shape, 0u);
  EXPECT_EQ(parts[0].blend.segments.skeletons, parts[1].blend.segments.skeletons);
  EXPECT_EQ(parts[1].world_from_local, some_similarity());
  // The same field as that of the blend placed alone, whose map is baked into it.
  once.place(some_similarity(), once.blend({once.segment({{0, 0, 0}, {1, 1, 0}, 0.5, 0.3})}));
  const FieldProgram baked = compiled(once.description());
  ASSERT_TRUE(baked.parts()[0].is_in_world());
  const Vec3d p = some_similarity().point({0.2, 0.9, 0.3});
  EXPECT_NEAR(evaluate_part(parts[1], p).corrected, value(baked, p), 1e-12);
  EXPECT_LT(length(evaluate_part(parts[1], p).corrected_gradient - evaluate(baked, p).gradient), 1e-12);
}

TEST(Compile, FlattensPolylinesAndSkeletonsToSegmentsAndLoneRootsToPoints) {
  Builder builder;
  auto graph = std::make_shared<SkeletonGraph>();
  graph->positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {9, 9, 9}};
  graph->radii = {0.3, 0.2, 0.1, 0.5};
  graph->parents = {-1, 0, 1, -1};
  const auto line = builder.add(primitive(PolylineSkeleton{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {0.3, 0.2, 0.1}}));
  const auto tree = builder.add(primitive(SharedSkeletonGraph(graph), MaterialId{2}));
  const auto first = builder.blend({line}), second = builder.blend({tree});
  builder.add(Union{{first, second}});
  const FieldProgram program = compiled(builder.description());
  const BlendField &a = program.parts()[0].blend, &b = program.parts()[1].blend;
  EXPECT_EQ(a.segments.skeletons, b.segments.skeletons);
  EXPECT_EQ(a.segments.size(), 2u);
  ASSERT_EQ(b.points.size(), 1u);
  EXPECT_EQ(b.points.skeletons[0], (PointSkeleton{{9, 9, 9}, 0.5}));
  EXPECT_EQ(b.segments.material(1), MaterialId{2});
  EXPECT_TRUE(a.segments.materials.empty());
}

TEST(Compile, ResolvesAlphaAndModel) {
  Builder builder;
  const auto s = builder.segment({{0, 0, 0}, {1, 0, 0}, 0.5, 0.5});
  const auto none = builder.segment({{0, 0, 0}, {0, 0, 0}, 0.5, 0.7});
  Blend blend;
  blend.kernel.degree = 6;
  blend.alpha = AlphaSum{};
  blend.model = SkeletonModel::Distance;
  blend.of = {s, none};
  builder.add(blend);
  const FieldProgram program = compiled(builder.description());
  const BlendField& field = program.parts()[0].blend;
  EXPECT_EQ(field.alpha, std::numbers::pi / 2);
  EXPECT_EQ(field.degree, 6);
  EXPECT_EQ(field.distance_segments.size(), 1u);
  ASSERT_EQ(field.points.size(), 1u);  // the limit of a short distance segment
  EXPECT_EQ(field.points.skeletons[0].radius, 0.7);
}

TEST(Compile, SegmentsWithoutLengthAddNothingAndAreToldOf) {
  Builder builder;
  builder.blend({builder.segment({{1, 0, 0}, {1, 0, 0}, 0.5, 0.5}), builder.point({0, 0, 0}, 1)});
  const FieldProgram program = compiled(builder.description());
  EXPECT_TRUE(program.parts()[0].blend.segments.empty());
  ASSERT_EQ(program.warnings().size(), 1u);
  EXPECT_EQ(program.warnings()[0].severity, Severity::Warning);
  EXPECT_EQ(program.warnings()[0].where.line, 1);
}

// Names are words of the author: a mistyped one is no mistake, and has no effect.
TEST(Compile, TellsOfAnglesThatHaveNoEffect) {
  const auto warnings = [](const Alpha& alpha, std::optional<double> of_skeleton, std::vector<Attribute> attributes) {
    Builder builder;
    Primitive tube = primitive(SegmentSkeleton{{0, 0, 0}, {1, 0, 0}, 0.5, 0.5});
    tube.alpha = of_skeleton;
    tube.attributes = std::move(attributes);
    Blend blend;
    blend.alpha = alpha;
    blend.of = {builder.add(tube), builder.point({0, 2, 0}, 1)};
    builder.add(blend);
    return compiled(builder.description()).warnings();
  };
  const Attribute age{.name = "age", .values = {1}};
  ASSERT_EQ(warnings(AlphaAttribute{.name = "agee", .ramp = {}}, {}, {age}).size(), 1u);
  EXPECT_NE(warnings(AlphaAttribute{.name = "agee", .ramp = {}}, {}, {age})[0].message.find("`agee`"),
            std::string::npos);
  EXPECT_TRUE(warnings(AlphaAttribute{.name = "age", .ramp = {}}, {}, {age}).empty());
  EXPECT_TRUE(warnings(AlphaAttribute{.name = "radius", .ramp = {}}, {}, {}).empty());
  EXPECT_EQ(warnings(AlphaContact{}, 0.5, {}).size(), 1u);
  EXPECT_TRUE(warnings(AlphaPerSkeleton{}, 0.5, {}).empty());
}

TEST(Compile, ReportsEveryErrorAtItsPlace) {
  Builder builder;
  builder.point({0, 0, 0}, 0);                                              // line 1
  builder.segment({{0, 0, 0}, {1, 0, 0}, 1, -2});                           // line 2
  builder.add(primitive(PolylineSkeleton{{{0, 0, 0}, {1, 0, 0}}, {0.5}}));  // line 3
  builder.place(Affine::scale({1, 0, 1}), FieldNodeId{0});                  // line 4
  Blend blend;
  blend.kernel.degree = 2;
  blend.alpha = 2.0;
  blend.of = {FieldNodeId{0}};
  builder.add(blend);  // line 5, twice
  builder.add(Union{});
  std::vector<int> lines;
  for (const Diagnostic& d : errors(builder)) {
    lines.push_back(d.where.line);
    EXPECT_FALSE(d.hint.empty());
  }
  EXPECT_THAT(lines, testing::ElementsAre(1, 2, 3, 4, 5, 5, 6));
}

TEST(Compile, RefusesWhatABlendCannotHold) {
  Builder builder;
  const auto a = builder.point({0, 0, 0}, 1);
  const auto inner = builder.blend({a});
  const auto squashed = builder.place(Affine::scale({1, 2, 1}), a);
  const auto united = builder.add(Union{{a}});
  builder.blend({a, inner, builder.add(Union{{a, squashed}, true}), united});
  const Diagnostics all = errors(builder);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_THAT(all[0].message, HasSubstr("blend inside a blend"));
  EXPECT_THAT(all[0].hint, HasSubstr("`sum`"));  // what to write instead
  EXPECT_THAT(all[1].message, HasSubstr("changes shape"));
  EXPECT_THAT(all[2].message, HasSubstr("union inside a blend"));
  EXPECT_EQ(all[1].where.line, 3);
}

TEST(Compile, RefusesAnglesAndDegreesOutOfRange) {
  for (const double alpha : {-1.01, 1.58, std::nan("")}) {
    Builder builder;
    Blend blend;
    blend.alpha = alpha;
    blend.of = {builder.point({0, 0, 0}, 1)};
    builder.add(blend);
    EXPECT_EQ(errors(builder).size(), 1u) << alpha;
  }
  for (const int degree : {2, 21}) {
    Builder builder;
    Blend blend;
    blend.kernel.degree = degree;
    blend.of = {builder.point({0, 0, 0}, 1)};
    builder.add(blend);
    EXPECT_EQ(errors(builder).size(), 1u) << degree;
  }
}

TEST(Compile, RefusesADescriptionThatMultipliesWithoutEnd) {
  Builder builder;
  auto node = builder.point({0, 0, 0}, 1);
  for (int i = 0; i < 40; ++i) node = builder.add(Union{{node, node}});
  const Diagnostics all = errors(builder);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_THAT(all[0].message, HasSubstr("copies"));
}

TEST(Compile, FlattensAMillionNodesQuickly) {
  Builder builder;
  auto graph = std::make_shared<SkeletonGraph>();
  for (int i = 0; i < 1'000'000; ++i) {
    graph->positions.push_back({i * 0.1, 0, 0});
    graph->radii.push_back(0.1);
    graph->parents.push_back(i - 1);
  }
  builder.blend({builder.add(primitive(SharedSkeletonGraph(graph)))});
  const auto start = std::chrono::steady_clock::now();
  const FieldProgram program = compiled(builder.description());
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(program.parts()[0].blend.segments.size(), 999'999u);
  EXPECT_LT(seconds.count(), 5);  // generous: sanitizers and loaded machines; Release takes a twentieth
}

}  // namespace
}  // namespace marrow
