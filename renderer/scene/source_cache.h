// The texts that were read, so that a diagnostic can show the line it speaks of.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "field/base/diagnostics.h"

namespace marrow {

/// A place in one of the texts of a SourceCache; small, because every value of a document carries one.
struct Place {
  std::uint32_t file = 0;  ///< index in the cache
  std::int32_t line = 0;   ///< from 1; 0 is unknown
  std::int32_t column = 0;
};

class SourceCache {
 public:
  /// Keeps `text` under `name` and returns its index. Names need not differ.
  std::uint32_t add(std::string name, std::string text);
  const std::string& name(std::uint32_t file) const { return sources_[file].name; }
  SourceLocation location(const Place&) const;
  /// The text last kept under this name; empty when there is none.
  std::string_view text(std::string_view name) const;

 private:
  struct Source {
    std::string name, text;
  };
  std::vector<Source> sources_;
};

/// All of them, each with its line and caret where the cache knows the text, and a closing count of the errors.
std::string render_all(const Diagnostics&, const SourceCache&);

}  // namespace marrow
