// What the author may have meant.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace marrow {

/// Fewest single-character insertions, removals, replacements and swaps of neighbours that turn `a` into `b`
/// (optimal string alignment).
int edit_distance(std::string_view a, std::string_view b);

/// The candidate closest to `word`, if it is within a third of the word's length (at least one) of it.
std::optional<std::string> nearest(std::string_view word, const std::vector<std::string>& candidates);

/// "did you mean `x`? " where something is near, then "(allowed: …)", shortened when long.
std::string suggest(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace marrow
