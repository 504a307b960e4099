// Scenes that are right, and what they say.
#include "renderer/scene/read_scene.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scene/scene_text.h"
#include "tests/source_folder.h"

namespace marrow {
namespace {

using testing::HasSubstr;
using ReadScene = SceneText;

TEST_F(ReadScene, GivesWhatTheTextSays) {
  const auto scene = read(R"(marrow: 1
units: um
up: z
camera: {type: orthographic, from: [0, 1, 6], height: 4}
film: {size: [320, 200]}
render: {integrator: normals, spp: 3, seed: 18446744073709551615, max_depth: 2}
lights:
  - sun: {direction: [0, 0, 2], irradiance: "#fff", angle: 0.5}
  - rectangle: {center: [0, 4, 2], size: [2, 3], radiance: 7}
  - point: {at: [1, 2, 3], intensity: {kelvin: 5600, luminance: 3}}
materials:
  skin: {diffuse: {color: [0.8, 0.5, 0.4]}}
  gold: {conductor: {metal: gold, roughness: 0.1}}
objects:
  - material: gold
    field:
      blend:
        kernel: {inverse: 5}
        alpha: 30deg
        cavity: false
        projection: exact
        of:
          - segment: {from: [0, 0, 0], to: [1, 0, 0], radius: [0.5, 0.2], alpha: 0.9, material: skin, model: distance}
          - polyline: {points: [[0, 0, 0], [1, 0, 0], [1, 1, 0]], radius: 0.3}
  - {name: floor, plane: {point: [0, -1, 0], normal: [0, 1, 0]}}
)");
  ASSERT_TRUE(scene) << render_all(scene.why(), record.sources);
  EXPECT_EQ(scene->units, "um");
  EXPECT_TRUE(scene->z_up);
  EXPECT_EQ(scene->camera.type, CameraDescription::Type::Orthographic);
  EXPECT_EQ(scene->film.height, 200);
  EXPECT_EQ(scene->render.seed, UINT64_MAX);
  EXPECT_EQ(std::get<SunLight>(scene->lights[0].what).irradiance, Rgb(1));
  EXPECT_EQ(std::get<RectangleLight>(scene->lights[1].what).height, 3);
  EXPECT_NEAR(luminance(std::get<PointLight>(scene->lights[2].what).intensity), 3, 1e-12);
  EXPECT_EQ(scene->materials[1].name, "gold");
  EXPECT_EQ(scene->objects[0].name, "object 1");
  EXPECT_EQ(scene->objects[0].material, MaterialId{1});
  EXPECT_EQ(scene->materials[scene->objects[1].material.index()].name, "default");

  const auto& field = std::get<FieldDescription>(scene->objects[0].shape);
  const auto& blend = std::get<Blend>(field[field.root].what);
  EXPECT_EQ(blend.kernel.degree, 5);
  EXPECT_NEAR(std::get<double>(blend.alpha), 0.52359877559829887, 1e-15);
  EXPECT_FALSE(blend.cavity);
  EXPECT_EQ(blend.projection, Projection::Exact);
  const auto& segment = std::get<Primitive>(field[blend.of[0]].what);
  EXPECT_EQ(std::get<SegmentSkeleton>(segment.skeleton), (SegmentSkeleton{{0, 0, 0}, {1, 0, 0}, 0.5, 0.2}));
  EXPECT_EQ(segment.alpha, 0.9);
  EXPECT_EQ(segment.model, SkeletonModel::Distance);
  EXPECT_EQ(segment.material, MaterialId{0});
  const auto& line = std::get<Primitive>(field[blend.of[1]].what);
  EXPECT_EQ(std::get<PolylineSkeleton>(line.skeleton).radii, (std::vector<double>{0.3, 0.3, 0.3}));
  EXPECT_EQ(field[blend.of[1]].where.line, 24);
}

TEST_F(ReadScene, NeedsOnlyItsVersion) {
  const auto scene = read("marrow: 1\n");
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->film.width, 1280);
  EXPECT_TRUE(scene->objects.empty());
}

TEST_F(ReadScene, ContactIsTheDefaultAlphaAndSumAWord) {
  const auto scene = read(
      "marrow: 1\nobjects:\n  - field: {blend: {alpha: sum, of: [{point: {at: [0, 0, 0]}}]}}\n"
      "  - field: {blend: {of: [{point: {at: [0, 0, 0]}}]}}\n");
  ASSERT_TRUE(scene) << render_all(scene.why(), record.sources);
  const auto alpha = [&](std::size_t i) {
    const auto& field = std::get<FieldDescription>(scene->objects[i].shape);
    return std::get<Blend>(field[field.root].what).alpha.index();
  };
  EXPECT_EQ(alpha(0), 1u);
  EXPECT_EQ(alpha(1), 0u);
}

TEST_F(ReadScene, TransformsScaleThenRotateThenMove) {
  const auto scene = read(
      "marrow: 1\nobjects:\n  - field: {transform: {translate: [10, 0, 0], rotate: {axis: [0, 0, 1], "
      "angle: 90}, scale: [2, 1, 1], of: {point: {at: [0, 0, 0]}}}}\n");
  ASSERT_TRUE(scene) << render_all(scene.why(), record.sources);
  const auto& field = std::get<FieldDescription>(scene->objects[0].shape);
  const Vec3d moved = std::get<Transform>(field[field.root].what).parent_from_child.point({1, 0, 0});
  EXPECT_LT(length(moved - Vec3d{10, 2, 0}), 1e-12);
}

TEST_F(ReadScene, UsesShareTheirNodesAndChildrenStandBeforeParents) {
  const auto scene = read(R"(marrow: 1
defs:
  pair: {union: {of: [{use: ball}, {use: ball}]}}
  ball: {point: {at: [0, 0, 0], radius: 2}}
objects:
  - field: {union: {of: [{use: pair}, {use: ball}, {use: pair}]}}
)");
  ASSERT_TRUE(scene) << render_all(scene.why(), record.sources);
  const auto& field = std::get<FieldDescription>(scene->objects[0].shape);
  EXPECT_EQ(field.nodes.size(), 3u) << "ball, pair, and the union";
  for (std::size_t i = 0; i < field.nodes.size(); ++i)
    if (const auto* all = std::get_if<Union>(&field.nodes[i].what)) {
      for (const FieldNodeId child : all->of) EXPECT_LT(child.index(), i);
    }
  EXPECT_EQ(field.root.index(), 2u);
}

TEST_F(ReadScene, SubtreesOfSeveralObjectsAreKnownToBeTheSame) {
  const auto scene = read(R"(marrow: 1
defs:
  pair: {blend: {of: [{point: {at: [0, 0, 0], radius: 1}}, {point: {at: [1, 0, 0], radius: 1}}]}}
  once: {point: {at: [5, 0, 0], radius: 2}}
objects:
  - field: {transform: {translate: [9, 0, 0], of: {use: pair}}}
  - field: {union: {of: [{use: once}, {use: pair}]}}
)");
  ASSERT_TRUE(scene) << render_all(scene.why(), record.sources);
  std::vector<std::size_t> pairs;
  for (const ObjectDescription& object : scene->objects)
    for (const FieldNode& node : std::get<FieldDescription>(object.shape).nodes) {
      const auto* primitive = std::get_if<Primitive>(&node.what);
      const bool is_once = primitive && std::get<PointSkeleton>(primitive->skeleton).radius == 2;
      EXPECT_TRUE(!is_once || node.shared == 0) << "only one object holds it";
      if (std::holds_alternative<Blend>(node.what)) pairs.push_back(node.shared);
    }
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_NE(pairs[0], 0u);
  EXPECT_EQ(pairs[0], pairs[1]);
}

TEST_F(ReadScene, ChainsOfUsesMayBeLong) {
  std::string text = "marrow: 1\ndefs:\n  x0: {point: {at: [0, 0, 0]}}\n";
  for (int i = 1; i <= 1000; ++i)
    text += "  x" + std::to_string(i) + ": {transform: {of: {use: x" + std::to_string(i - 1) + "}}}\n";
  const auto scene = read(text + "objects: [{field: {use: x1000}}]\n");
  ASSERT_TRUE(scene) << render_all(scene.why(), record.sources);
  EXPECT_EQ(std::get<FieldDescription>(scene->objects[0].shape).nodes.size(), 1001u);
}

TEST_F(ReadScene, IncludesBringMaterialsAndSubtrees) {
  std::filesystem::create_directories(folder / "parts");
  write("parts/a.yaml", "include: b.yaml\nmaterials: {skin: {diffuse: {color: 0.5}}}\n");
  write("parts/b.yaml", "defs: {neuron: {blend: {of: [{skeleton: {file: n.swc}}]}}}\n");
  write("parts/n.swc", "1 1 0 0 0 1 -1\n2 1 1 0 0 1 1\n");
  const auto scene = read(
      "marrow: 1\ninclude: [parts/a.yaml, parts/b.yaml]\nobjects:\n"
      "  - {name: n, material: skin, field: {use: neuron}}\n");
  ASSERT_TRUE(scene) << render_all(scene.why(), record.sources);
  EXPECT_EQ(record.files.size(), 5u);  // b.yaml is looked at twice, and merged once
}

TEST_F(ReadScene, IncludesAreAtMostSixteenDeep) {
  for (int i = 0; i < 18; ++i)
    write("f" + std::to_string(i) + ".yaml", "include: f" + std::to_string(i + 1) + ".yaml\n");
  write("f18.yaml", "defs: {}\n");
  EXPECT_THAT(error_of("marrow: 1\ninclude: f0.yaml\n"), HasSubstr("more than 16 deep"));
  EXPECT_TRUE(read("marrow: 1\ninclude: f4.yaml\n"));
}

TEST_F(ReadScene, ASkeletonThatIsPlacedTwiceIsHeldOnce) {
  write("n.swc", "1 1 0 0 0 1 -1\n2 1 1 0 0 0 1\n");
  const auto scene =
      read("marrow: 1\nobjects:\n  - field: {skeleton: {file: n.swc}}\n  - field: {skeleton: {file: n.swc}}\n");
  ASSERT_TRUE(scene) << render_all(scene.why(), record.sources);
  const auto graph = [&](std::size_t i) {
    const auto& field = std::get<FieldDescription>(scene->objects[i].shape);
    return std::get<SharedSkeletonGraph>(std::get<Primitive>(field[field.root].what).skeleton);
  };
  EXPECT_EQ(graph(0), graph(1));
  ASSERT_EQ(record.warnings.size(), 1u);
  EXPECT_THAT(record.warnings[0].message, HasSubstr("1 of 2 nodes have the radius 0"));
}

TEST_F(ReadScene, CurvesBranchAndClose) {
  const auto scene = read(R"(marrow: 1
objects:
  - field:
      blend:
        of:
          - curve: {points: [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 1, 0], [3, -1, 0]], radius: [1, 1, 2, 1, 1], levels: 1,
                    branches: [[0, 1, 2], [2, 3], [2, 4]], attributes: {heat: [1, 2, 3, 4, 5]}}
          - polyline: {points: [[0, 0, 0], [1, 0, 0], [0, 1, 0]], radius: 0.1, closed: true,
                       attributes: {heat: [1, 2, 3], other: 4}}
)");
  ASSERT_TRUE(scene) << render_all(scene.why(), record.sources);
  const auto& field = std::get<FieldDescription>(scene->objects[0].shape);
  const auto skeleton = [&](std::size_t i) { return std::get<Primitive>(field.nodes[i].what).skeleton; };
  const SkeletonGraph graph = *std::get<SharedSkeletonGraph>(skeleton(0));
  EXPECT_EQ(graph.parents, (std::vector<std::int32_t>{-1, 0, 1, 2, -1, 4, -1, 6}));
  for (const std::size_t meeting : {3u, 4u, 6u}) EXPECT_EQ(graph.positions[meeting], (Vec3d{2, 0, 0}));
  EXPECT_EQ(graph.radii[3], 2);
  const std::vector<Attribute> heat = std::get<Primitive>(field.nodes[0].what).attributes;
  ASSERT_EQ(heat[0].values.size(), graph.radii.size());
  for (const std::size_t meeting : {3u, 4u, 6u}) EXPECT_EQ(heat[0].values[meeting], 3);
  for (const auto& [end, value] : {std::pair{0u, 1.0}, {5u, 4.0}, {7u, 5.0}}) EXPECT_EQ(heat[0].values[end], value);
  EXPECT_EQ(std::get<PolylineSkeleton>(skeleton(1)).points.size(), 4u);
  const std::vector<Attribute> closed{{"heat", {1, 2, 3, 1}}, {"other", {4}}};
  EXPECT_EQ(std::get<Primitive>(field.nodes[1].what).attributes, closed);
}

TEST_F(ReadScene, SkeletonsOfFilesAreSimplifiedAndSmoothed) {
  write("n.swc", "1 1 0 0 0 1 -1\n2 1 1 0 0 1 1\n3 1 2 0 0 1 2\n4 1 2 2 0 1 3\n");
  const auto nodes = [&](const std::string& options) {
    const auto scene = read("marrow: 1\nobjects:\n  - field: {skeleton: {file: n.swc" + options + "}}\n");
    const auto& field = std::get<FieldDescription>(scene->objects[0].shape);
    return std::get<SharedSkeletonGraph>(std::get<Primitive>(field[field.root].what).skeleton)->positions.size();
  };
  EXPECT_EQ(nodes(""), 4u);
  EXPECT_EQ(nodes(", simplify: 0.001"), 3u);
  EXPECT_EQ(nodes(", levels: 1"), 6u);
  EXPECT_EQ(nodes(", subdivision: cubic"), 13u);
  EXPECT_EQ(nodes(", simplify: 0.001, subdivision: cubic, levels: 1"), 5u);
}

TEST_F(ReadScene, ARadiusForAllLeavesNothingToScale) {
  write("n.swc", "1 1 0 0 0 1 -1\n2 1 1 0 0 1 1\n");
  const auto with = [](const std::string& options) {
    return "marrow: 1\nobjects:\n  - field: {skeleton: {file: n.swc, " + options + "}}\n";
  };
  EXPECT_TRUE(read(with("radius: 0.5")));
  EXPECT_TRUE(read(with("radius_scale: 2")));
  EXPECT_THAT(error_of(with("radius: 0.5, radius_scale: 2")), HasSubstr("`radius_scale` has no effect"));
}

TEST_F(ReadScene, TheHashIsOfAllThatWasRead) {
  write("n.swc", "1 1 0 0 0 1 -1\n");
  const std::string text = "marrow: 1\nobjects:\n  - field: {skeleton: {file: n.swc}}\n";
  const std::string hash = read(text)->hash;
  EXPECT_EQ(hash.size(), 32u);
  EXPECT_EQ(read(text)->hash, hash);
  EXPECT_NE(read(text + "# more\n")->hash, hash);
  EXPECT_NE(read(text, {.overrides = {"render.spp=64"}})->hash, hash);
  write("n.swc", "1 1 0 0 0 2 -1\n");
  EXPECT_NE(read(text)->hash, hash);
}

TEST_F(ReadScene, SamplesOfTheRepositoryLoad) {
  for (const char* name : {"rat_ca1_pyramidal_NMO_49821.swc", "tree.swc", "vessel.swc", "1crn.pdb", "tuft.hair"}) {
    const std::string file = test::source_folder() + "/scenes/data/" + name;
    EXPECT_TRUE(read("marrow: 1\nobjects:\n  - field: {skeleton: {file: " + file + "}}\n")) << name;
  }
}

TEST_F(ReadScene, AByteOrderMarkIsNoPartOfTheText) { EXPECT_TRUE(read("\xEF\xBB\xBFmarrow: 1\n")); }

TEST_F(ReadScene, KnowsEveryRuleForTheAngle) {
  const auto scene = read(R"(marrow: 1
defs:
  hot: {point: {at: [0, 0, 0]}}
objects:
  - field: {blend: {alpha: {direction: [0.1, 0.5]}, of: [{use: hot}]}}
  - field: {blend: {alpha: {direction: {min: 0.1, max: 0.5}}, of: [{point: {at: [0, 0, 0], alpha_bounds: [0.2, 0.3]}}]}}
  - field:
      blend:
        alpha: {attribute: heat, from: [0, 10], to: [0.2, 1.2]}
        of: [{segment: {from: [0, 0, 0], to: [1, 0, 0], attributes: {heat: [1, 9], other: 3}}}]
  - field: {blend: {of: [{use: hot}], alpha: {field: {use: hot}, from: [0, 10], to: [0.2, 1.2]}}}
  - field: {blend: {alpha: {contact: {density: false}}, of: [{use: hot}]}}
)");
  ASSERT_TRUE(scene) << render_all(scene.why(), record.sources);
  const auto field = [&](std::size_t i) -> const FieldDescription& {
    return std::get<FieldDescription>(scene->objects[i].shape);
  };
  const auto blend = [&](std::size_t i) -> const Blend& { return std::get<Blend>(field(i)[field(i).root].what); };
  for (const std::size_t i : {0u, 1u}) {
    EXPECT_EQ(std::get<AlphaDirection>(blend(i).alpha).least, 0.1);
    EXPECT_EQ(std::get<AlphaDirection>(blend(i).alpha).most, 0.5);
  }
  EXPECT_EQ(std::get<Primitive>(field(1)[blend(1).of[0]].what).alpha_bounds, (std::array{0.2, 0.3}));
  EXPECT_EQ(std::get<AlphaAttribute>(blend(2).alpha).name, "heat");
  EXPECT_EQ(std::get<AlphaAttribute>(blend(2).alpha).ramp, (AlphaRamp{{0, 10}, {0.2, 1.2}}));
  EXPECT_EQ(std::get<Primitive>(field(2)[blend(2).of[0]].what).attributes,
            (std::vector<Attribute>{{"heat", {1, 9}}, {"other", {3}}}));
  const FieldNodeId steering = std::get<AlphaFromField>(blend(3).alpha).field;
  ASSERT_TRUE(steering.valid() && steering < field(3).root);
  EXPECT_TRUE(std::holds_alternative<Primitive>(field(3)[steering].what));
  EXPECT_TRUE(std::get<AlphaLocalContact>(blend(4).alpha).radii);
  EXPECT_FALSE(std::get<AlphaLocalContact>(blend(4).alpha).density);
}

TEST_F(ReadScene, AnArcOfAWholeTurnMayBeginAnywhere) {
  const auto arc = [&](const std::string& angles) {
    return read("marrow: 1\nobjects: [{field: {blend: {of: [{arc: {angles: " + angles + "}}]}}}]\n");
  };
  EXPECT_TRUE(arc("[152.2, 512.2]"));
  EXPECT_TRUE(arc("[271.29363606773626, 631.29363606773632]"));
  EXPECT_FALSE(arc("[152.2, 512.2000001]"));
}

TEST_F(ReadScene, KnowsEverySkeletonAndKernel) {
  const auto scene = read(R"(marrow: 1
objects:
  - field:
      blend:
        alpha: per_skeleton
        of:
          - curve: {points: [[0, 0, 0], [1, 0, 0], [1, 1, 0]], radius: 0.2, subdivision: cubic, levels: 2, sticking: [1]}
          - triangle: {vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]], radius: [0.1, 0.2, 0.3], alpha: 0.7}
          - circle: {center: [0, 0, 1], axes: [[0, 2, 0], [0, 0, 3]], major: 2, radius: 0.3}
          - arc: {major: 1, angles: [-90, 0.5rad], radius: [0.3, 0.1]}
  - field: {blend: {kernel: {cauchy: 5, scale: 1.5}, alpha: sum, of: [{point: {at: [0, 0, 0]}}]}}
  - field: {blend: {kernel: {compact: 6}, alpha: sum, of: [{point: {at: [0, 0, 0]}}]}}
)");
  ASSERT_TRUE(scene) << render_all(scene.why(), record.sources);
  const auto& field = std::get<FieldDescription>(scene->objects[0].shape);
  const auto& blend = std::get<Blend>(field[field.root].what);
  EXPECT_TRUE(std::holds_alternative<AlphaPerSkeleton>(blend.alpha));
  const auto child = [&](std::size_t i) -> const Primitive& { return std::get<Primitive>(field[blend.of[i]].what); };
  const auto& curve = std::get<CurveSkeleton>(child(0).skeleton);
  EXPECT_EQ(curve.subdivision, Subdivision::Cubic);
  EXPECT_EQ(curve.sticking, std::vector<int>{1});
  EXPECT_EQ(curve.radii, (std::vector<double>{0.2, 0.2, 0.2}));
  EXPECT_EQ(std::get<TriangleSkeleton>(child(1).skeleton).radii, (std::array<double, 3>{0.1, 0.2, 0.3}));
  EXPECT_EQ(child(1).alpha, 0.7);
  const auto& circle = std::get<ArcSkeleton>(child(2).skeleton);
  EXPECT_EQ(circle.axis1, (Vec3d{0, 1, 0}));
  EXPECT_EQ(circle.axis2, (Vec3d{0, 0, 1}));
  EXPECT_NEAR(circle.end - circle.begin, 6.283185307179586, 1e-15);
  const auto& arc = std::get<ArcSkeleton>(child(3).skeleton);
  EXPECT_NEAR(arc.begin, -1.5707963267948966, 1e-15);
  EXPECT_NEAR(arc.end, 0.5, 1e-15);
  EXPECT_EQ(arc.radius_to, 0.1);
  const auto kernel_of = [&](std::size_t object) {
    const auto& tree = std::get<FieldDescription>(scene->objects[object].shape);
    return std::get<Blend>(tree[tree.root].what).kernel;
  };
  EXPECT_EQ(kernel_of(1), (Kernel{KernelFamily::Cauchy, 5, 1.5}));
  EXPECT_EQ(kernel_of(2), (Kernel{KernelFamily::Compact, 6, 2}));
}

}  // namespace
}  // namespace marrow
