// A YAML text as a tree of values that know their place. The only door to yaml-cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "field/base/diagnostics.h"
#include "renderer/scene/source_cache.h"

namespace marrow {

struct Member;

struct Value {
  enum class Kind : std::uint8_t {
    Absent,  ///< nothing, `~` or `null`
    Plain,   ///< a word or number without quotes
    Quoted,  ///< a text in quotes, or a block of text
    List,
    Map,
    Broken  ///< stands where a mistake has been reported already
  };
  Kind kind = Kind::Absent;
  Place place;
  std::string text;             ///< of Plain and Quoted
  std::vector<Value> items;     ///< of a List
  std::vector<Member> members;  ///< of a Map, in the order of the text, keys differ

  bool is_scalar() const { return kind == Kind::Plain || kind == Kind::Quoted; }
  explicit Value(Kind kind = Kind::Absent, Place place = {}, std::string text = {});
  const Member* find(std::string_view key) const;
  Member* find(std::string_view key);
};

struct Member {
  std::string key;
  Place place;  ///< of the key
  Value value;
};

/// What a reader of messages would call it: `abc`, a list of 3, a map, nothing.
std::string describe(const Value&);

/// Nesting of lists and maps. An operator takes three levels ({blend: {of: [...]}}), so this is 128 operators deep.
inline constexpr int max_nesting = 3 * 128;

struct YamlText {
  std::string_view text;
  Place origin;  ///< place of the first character, and the file
};

/// The tree, or nothing where the text is not YAML. Everything found goes to `problems`: syntax errors, duplicate
/// keys, anchors, aliases, merge keys, tags, keys that are no words, a second document, too deep nesting, text that
/// is not UTF-8. `values_left` is a budget that each value takes one from.
std::optional<Value> parse_yaml(const YamlText&, const SourceCache&, std::size_t& values_left, Diagnostics& problems);

}  // namespace marrow
