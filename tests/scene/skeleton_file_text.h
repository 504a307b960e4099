// Shared by the tests of skeleton files.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "renderer/scene/files/skeleton_file.h"

namespace marrow {

/// Reads a text that must fail and compares place and words of its first message.
inline void expect_file_error(SkeletonFormat format, std::string_view text, int line, int column,
                              std::string_view message, const SkeletonOptions& options = {}) {
  const auto file = read_skeleton(format, text, options, "t");
  ASSERT_FALSE(file) << text;
  const Diagnostic& first = file.why()[0];
  EXPECT_EQ(first.where.line, line) << text << '\n' << first.message;
  EXPECT_EQ(first.where.column, column) << text << '\n' << first.message;
  EXPECT_NE(first.message.find(message), std::string::npos) << first.message;
  for (const Diagnostic& d : file.why()) EXPECT_FALSE(d.message.empty());
}

/// Where each mistake of a text stands, such as "3:14".
inline std::vector<std::string> places_of_mistakes(SkeletonFormat format, std::string_view text,
                                                   const SkeletonOptions& options = {}) {
  std::vector<std::string> places;
  const auto file = read_skeleton(format, text, options, "t");
  if (file) return places;
  for (const Diagnostic& d : file.why())
    places.push_back(std::to_string(d.where.line) + ':' + std::to_string(d.where.column));
  return places;
}

/// Reads a text that must be right; ends the test otherwise.
inline SkeletonFile read_good_file(SkeletonFormat format, std::string_view text, const SkeletonOptions& options = {}) {
  auto file = read_skeleton(format, text, options, "t");
  if (file) return std::move(*file);
  throw std::runtime_error(render(file.why()[0], text));
}

}  // namespace marrow
