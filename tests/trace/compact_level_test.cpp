// What levels are made of: nodes written from pieces are those of their rules, with the same bits whatever the set.
#include "field/trace/levels/compact_level.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "field/math/elementary.h"
#include "field/trace/cells/precision.h"
#include "field/trace/sources/near_far.h"
#include "field/trace/sources/source_emitter.h"
#include "tests/field/random.h"

namespace marrow::test {
namespace {

constexpr int degree = 4;
const Vec3d center{0.3, -0.2, 0.1};
constexpr double half = 0.7;

Piece random_piece(Random& random) {
  Piece p;
  const auto place = [&] { return Vec3d{random.between(-2, 2), random.between(-2, 2), random.between(-2, 2)}; };
  p.from = place();
  p.to = p.from + place() * 0.3;
  p.radius_from = random.between(0.1, 1);
  p.radius_to = random.whole(0, 1) == 0 ? p.radius_from : random.between(0.1, 1);
  p.radius = std::max(p.radius_from, p.radius_to);
  p.length = length(p.to - p.from);
  p.mass = p.length * integer_power(p.radius, degree - 1);
  return p;
}

struct Lists {
  std::vector<CurvePiece> pieces;
  SourceGroups expected;  // found in double
};

// Of `count` pieces with rules of all sizes.
Lists random_lists(Random& random, int count) {
  Lists lists;
  for (int i = 0; i < count; ++i) {
    const Piece piece = random_piece(random);
    const int nodes = random.whole(1, most_rule_nodes);
    lists.pieces.push_back(curve_piece(piece, nodes, center, half, degree));
    add_nodes(piece, nodes, center, half, degree, lists.expected);
  }
  return lists;
}

std::vector<float> written(const Lists& lists, std::string_view set) {
  std::vector<float> groups(static_cast<std::size_t>(lists.expected.group_count() * floats_per_group));
  block_kernels(set)->write_nodes(lists.pieces.data(), static_cast<int>(lists.pieces.size()), node_table(),
                                  groups.data());
  return groups;
}

TEST(CompactLevel, NodesAreThoseOfTheirRules) {
  Random random(211);
  for (int round = 0; round < 300; ++round) {
    const Lists lists = random_lists(random, random.whole(0, 40));
    const std::vector<float> found = written(lists, "");
    for (std::size_t i = 0; i < found.size(); ++i) {
      const float expected = lists.expected.data()[i];
      // Lanes without a source exactly so; others within some roundings of places of up to 6.
      ASSERT_LE(std::fabs(found[i] - expected), expected == unused_place ? 0 : 2e-6F) << "float " << i;
      ASSERT_TRUE(expected != 0 || found[i] == 0) << "float " << i;
    }
  }
}

TEST(CompactLevel, AllInstructionSetsWriteTheSameBits) {
  Random random(212);
  for (int round = 0; round < 100; ++round) {
    const Lists lists = random_lists(random, random.whole(1, 40));
    const std::vector<float> expected = written(lists, "sse4");
    for (const char* set : {"avx2", "avx512"}) {
      if (block_kernels(set) == nullptr) continue;
      ASSERT_EQ(written(lists, set), expected) << set;
    }
  }
}

TEST(CompactLevel, OnlyWhatCanBeCompactIsNotKept) {
  EXPECT_EQ(kept_bytes_for(too_many_pieces, false), 0U);
  EXPECT_GT(kept_bytes_for(too_many_pieces - 1, false), 0U);
  EXPECT_GT(kept_bytes_for(too_many_pieces, true), 0U);
}

TEST(CompactLevel, CopiesHoldTheSame) {
  Random random(213);
  std::vector<float> first(1 << 16), second(1 << 16), levels[2];
  const auto in = [](std::vector<float>& memory) {
    return [&memory](std::size_t floats) {
      EXPECT_LE(floats + lanes, memory.size());
      void* at = memory.data();
      std::size_t room = memory.size() * sizeof(float);
      return static_cast<float*>(std::align(64, floats * sizeof(float), at, room));
    };
  };
  const Lists lists = random_lists(random, 30);
  CompactParts parts{.curves = lists.pieces, .points = {}, .far = {}};
  parts.points.add({1, 2, 3}, 0.5, 0.25);
  parts.far.degree = 2;
  parts.far.coefficients.assign(10, {1, 2, 3, 4});
  const CompactLevel& made = write_compact(parts, in(first));
  const CompactLevel& copy = copy_of(made, in(second));
  const auto all_of = [&](const CompactLevel& level, std::vector<float>& memory) {
    memory.resize(1 << 16);
    const BlockLevel whole = expanded(level, *block_kernels(""), in(memory));
    const FieldLevel& l = whole.level;
    return std::vector<float>(l.sources, l.sources + (l.curve_groups + l.point_groups) * floats_per_group + 40);
  };
  const std::vector<float> expected = all_of(made, levels[0]);
  std::fill(first.begin(), first.end(), 0.0F);  // nothing of the copy lies there
  EXPECT_EQ(all_of(copy, levels[1]), expected);
  EXPECT_EQ(expected[expected.size() - 40], 1);  // the polynomials follow the sources
}

}  // namespace
}  // namespace marrow::test
