// Mistakes in the keys of a map, whatever the map is.
#include "renderer/scene/table.h"

#include <algorithm>

#include <fmt/core.h>

#include "renderer/scene/suggestion.h"

namespace marrow {
namespace {

template <class Infos>
std::vector<std::string> names(const Infos& infos) {
  std::vector<std::string> all;
  for (const auto& info : infos) all.push_back(info.name);
  return all;
}

std::string quoted_list(const std::vector<std::string>& words) {
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i)
    list += (i == 0 ? "`" : i + 1 == words.size() ? " or `" : ", `") + words[i] + "`";
  return list;
}

void check_exactly_one(const TableInfo& info, const Value& v, Reader& reader, bool& complete) {
  std::vector<const Member*> found;
  for (const std::string& name : info.exactly_one)
    if (const Member* member = v.find(name)) found.push_back(member);
  if (found.size() == 1 || info.exactly_one.empty()) return;
  complete = false;
  if (found.empty()) reader.error(v.place, reader.subject + " needs one of " + quoted_list(info.exactly_one));
  else
    reader.error(found[1]->place, "`" + found[1]->key + "` cannot stand beside `" + found[0]->key + "`",
                 reader.subject + " has exactly one of " + quoted_list(info.exactly_one), found[1]->key.size());
}

}  // namespace

std::string reference_to(const std::string& definition) {
  return fmt::format("{{\"$ref\":\"#/definitions/{}\"}}", definition);
}

bool check_members(const TableInfo& info, const Value& v, Reader& reader, bool& complete) {
  const std::vector<std::string> known = names(info.keys);
  if (v.kind != Value::Kind::Map) {
    reader.wrong(v, "a map", v.kind == Value::Kind::Broken ? "" : "keys: " + quoted_list(known));
    return false;
  }
  for (const Member& member : v.members) {
    if (std::find(known.begin(), known.end(), member.key) != known.end()) continue;
    reader.unknown("key", member.key, member.place, known);
    complete = false;
  }
  for (const KeyInfo& key : info.keys) {
    if (!key.is_required || v.find(key.name)) continue;
    reader.error(v.place, reader.subject + " needs the key `" + key.name + "`",
                 "`" + key.name + "` is " + key.words + ": " + key.doc);
    complete = false;
  }
  check_exactly_one(info, v, reader, complete);
  return true;
}

std::optional<std::size_t> find_alternative(const AlternativesInfo& info, const Value& v, Reader& reader) {
  const std::vector<std::string> known = names(info.list);
  const std::string what = "a " + info.name + " (a map of one key)";
  if (v.kind != Value::Kind::Map || v.members.empty()) return reader.wrong(v, what, suggest(v.text, known));
  for (const Member& member : v.members)
    if (std::find(info.later.begin(), info.later.end(), member.key) != info.later.end())
      return reader.not_yet(member.key, member.place);
  const Member& first = v.members[0];
  const auto found = std::find(known.begin(), known.end(), first.key);
  if (found == known.end()) return reader.unknown(info.name, first.key, first.place, known);
  if (v.members.size() > 1) {
    const Member& second = v.members[1];
    reader.error(second.place, "`" + second.key + "` cannot stand beside `" + first.key + "`",
                 "one key names a " + info.name + "; its parameters stand under it", second.key.size());
    return std::nullopt;
  }
  return static_cast<std::size_t>(found - known.begin());
}

}  // namespace marrow
