// What authors may write, and what they are told.
#include "materials/material.h"

#include <gtest/gtest.h>

namespace marrow {
namespace {

TEST(Material, CompilesEveryKind) {
  EXPECT_TRUE(compile(DiffuseDescription{}));
  EXPECT_TRUE(compile(ConductorDescription{}));
  EXPECT_TRUE(compile(CoatedDescription{}));
}

TEST(Material, UnknownMetalIsAnErrorThatNamesTheKnownOnes) {
  const auto made = compile(ConductorDescription{.metal = "glod", .roughness = 2});
  ASSERT_FALSE(made);
  ASSERT_EQ(made.why().size(), 2u);  // the roughness is wrong as well
  EXPECT_NE(made.why()[0].message.find("glod"), std::string::npos);
  EXPECT_NE(made.why()[0].hint.find("gold"), std::string::npos);
}

TEST(Material, ColoursOutOfRangeAreErrors) {
  EXPECT_FALSE(compile(DiffuseDescription{.color = Rgb(1.2)}));
  EXPECT_FALSE(compile(CoatedDescription{.color = Rgb(-0.1), .roughness = 0.1, .ior = 1.5}));
  EXPECT_FALSE(compile(CoatedDescription{.color = Rgb(0.5), .roughness = 0.1, .ior = 0.9}));
}

TEST(Material, AlbedoIsTheShareOfDiffuseLightReflected) {
  EXPECT_EQ(compile(DiffuseDescription{.color = Rgb(0.3)})->albedo_at({}), Rgb(0.3));
  EXPECT_NEAR(compile(CoatedDescription{.color = Rgb(1), .roughness = 0.3, .ior = 1.5})->albedo_at({}).r, 1, 1e-12);
}

}  // namespace
}  // namespace marrow
