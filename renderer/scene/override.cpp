// All overrides form one text called "-D", one a line, so that their mistakes have places like any other.
#include "renderer/scene/override.h"

#include <optional>
#include <string_view>
#include <utility>

#include "renderer/scene/scalar.h"
#include "renderer/scene/suggestion.h"

namespace marrow {
namespace {

std::vector<std::string> names_of_items(const Value& list) {
  std::vector<std::string> names;
  for (const Value& item : list.items)
    if (const Member* name = item.find("name")) names.push_back(name->value.text);
  return names;
}

// An item by index, or by the `name` that it gives itself.
Value* find_item(Value& list, const std::string& step, const Place& at, Reader& reader) {
  if (const auto index = parse_unsigned(step)) {
    if (*index < list.items.size()) return &list.items[*index];
    reader.error(at, "there is no item " + step + "; the list has " + std::to_string(list.items.size()),
                 "items count from 0", step.size());
    return nullptr;
  }
  for (Value& item : list.items)
    if (const Member* name = item.find("name"); name && name->value.text == step) return &item;
  reader.unknown("item", step, at, names_of_items(list));
  return nullptr;
}

// The value at one step of a path; a map gets a new key, which the tables check later.
Value* step_into(Value& parent, const std::string& step, const Place& at, Reader& reader) {
  if (parent.kind == Value::Kind::List) return find_item(parent, step, at, reader);
  if (parent.kind == Value::Kind::Absent) parent = Value(Value::Kind::Map, at);
  if (parent.kind != Value::Kind::Map) {
    reader.error(at, "`" + step + "` leads into " + describe(parent) + ", which is neither a map nor a list", "",
                 step.size());
    return nullptr;
  }
  if (Member* known = parent.find(step)) return &known->value;
  parent.members.push_back({.key = step, .place = at, .value = Value(Value::Kind::Absent, at)});
  return &parent.members.back().value;
}

void apply(Value& scene, std::string_view text, Place at, Reader& reader, std::size_t& values_left) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0)
    return reader.error(at, "an override is path=value", "such as render.spp=16");
  const Place value_place{at.file, at.line, at.column + static_cast<int>(equals) + 1};
  auto value = parse_yaml({text.substr(equals + 1), value_place}, reader.sources, values_left, reader.problems);
  if (!value) return;
  Value* target = &scene;
  std::string_view path = text.substr(0, equals);
  if (path.substr(0, path.find('.')) == "include")
    return reader.error(at, "`include` cannot be set here: files are included before",
                        "write a scene that includes the other file", equals);
  while (target) {
    const std::size_t dot = std::min(path.find('.'), path.size());
    target = step_into(*target, std::string(path.substr(0, dot)), at, reader);
    if (dot == path.size()) break;
    path.remove_prefix(dot + 1);
    at.column += static_cast<int>(dot) + 1;
  }
  if (target) *target = *std::move(value);
}

}  // namespace

void apply_overrides(Value& scene, const std::vector<std::string>& overrides, Reader& reader,
                     std::size_t& values_left) {
  if (overrides.empty()) return;
  std::string text;
  for (const std::string& one : overrides) {
    reader.files.add_to_hash(one);
    for (const char c : one) text += c == '\n' ? ' ' : c;  // one line each
    text += '\n';
  }
  const std::uint32_t file = reader.sources.add("-D", text);
  std::string_view rest = text;
  for (int line = 1; !rest.empty(); ++line) {
    const std::size_t end = rest.find('\n');
    apply(scene, rest.substr(0, end), {.file = file, .line = line, .column = 1}, reader, values_left);
    rest.remove_prefix(end + 1);
  }
}

}  // namespace marrow
