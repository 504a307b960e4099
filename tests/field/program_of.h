// Blends as authors write them, compiled.
#pragma once

#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "field/program/field_program.h"

namespace marrow::test {

/// One blend. `others`: nodes that its angle names.
inline FieldProgram program_of(const std::vector<Primitive>& primitives, const Alpha& alpha,
                               FieldDescription others = {}, const Kernel& kernel = {}) {
  FieldDescription description = std::move(others);
  Blend blend;
  blend.alpha = alpha;
  blend.kernel = kernel;
  for (const Primitive& p : primitives) blend.of.push_back(description.add({.what = p, .where = {}}));
  description.root = description.add({.what = blend, .where = {}});
  auto program = compile(description);
  EXPECT_TRUE(program) << (program ? "" : program.why().front().message);
  return program ? *std::move(program) : FieldProgram{};
}

}  // namespace marrow::test
