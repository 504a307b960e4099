// Prints the tables.
#include "renderer/scene/schema.h"

#include <fmt/format.h>

#include "renderer/scene/field_forms.h"
#include "renderer/scene/scene_forms.h"

namespace marrow {
namespace {

// "a": b, "c": d without the outer braces.
class Members {
 public:
  void add(const std::string& key, const std::string& json) {
    text_ += fmt::format("{}{}:{}", text_.empty() ? "" : ",", json_string(key), json);
  }
  std::string object() const { return fmt::format("{{{}}}", text_); }

 private:
  std::string text_;
};

// An annotation beside a $ref would be ignored by draft-07; allOf keeps both.
std::string described(const KeyInfo& key) {
  const std::string doc = key.doc + (key.fallback.empty() ? "" : " (default " + key.fallback + ")");
  if (key.json.starts_with("{\"$ref\""))
    return fmt::format("{{\"description\":{},\"allOf\":[{}]}}", json_string(doc), key.json);
  return fmt::format("{{\"description\":{},{}", json_string(doc), key.json.substr(1));
}

std::string table_json(const TableInfo& table) {
  Members properties;
  std::vector<std::string> required, one_of;
  for (const KeyInfo& key : table.keys) {
    properties.add(key.name, described(key));
    if (key.is_required) required.push_back(json_string(key.name));
  }
  for (const std::string& name : table.exactly_one)
    one_of.push_back(fmt::format("{{\"required\":[{}]}}", json_string(name)));
  Members json;
  json.add("type", "\"object\"");
  json.add("description", json_string(table.doc));
  json.add("properties", properties.object());
  if (!required.empty()) json.add("required", fmt::format("[{}]", fmt::join(required, ",")));
  if (!one_of.empty()) json.add("oneOf", fmt::format("[{}]", fmt::join(one_of, ",")));
  json.add("additionalProperties", "false");
  return json.object();
}

std::string alternatives_json(const AlternativesInfo& alternatives) {
  Members properties, json;
  for (const auto& one : alternatives.list) properties.add(one.name, one.json);
  json.add("type", "\"object\"");
  json.add("description", json_string(alternatives.doc));
  json.add("properties", properties.object());
  json.add("minProperties", "1");
  json.add("maxProperties", "1");
  json.add("additionalProperties", "false");
  return json.object();
}

// Indents JSON by two; strings are left alone.
std::string indented(const std::string& json) {
  std::string out;
  std::size_t depth = 0;
  bool in_string = false;
  const auto new_line = [&] { out += '\n' + std::string(2 * depth, ' '); };
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (c == '"' && (i == 0 || json[i - 1] != '\\')) in_string = !in_string;
    if (in_string) out += c;
    else if (c == '{' || c == '[') out += c, ++depth, new_line();
    else if (c == '}' || c == ']') --depth, new_line(), out += c;
    else if (c == ',') out += c, new_line();
    else if (c == ':') out += ": ";
    else out += c;
  }
  return out + '\n';
}

std::string table_markdown(const TableInfo& table) {
  std::string out =
      fmt::format("### `{}`\n\n{}\n\n| key | value | default | |\n|---|---|---|---|\n", table.name, table.doc);
  for (const KeyInfo& key : table.keys) {
    const std::string fallback = key.is_required        ? "required"
                                 : key.fallback.empty() ? ""
                                                        : fmt::format("`{}`", key.fallback);
    out += fmt::format("| `{}` | {} | {} | {} |\n", key.name, key.words, fallback, key.doc);
  }
  if (!table.exactly_one.empty()) {
    out += fmt::format("\nExactly one of `{}`.\n", fmt::join(table.exactly_one, "`, `"));
  }
  return out + "\n";
}

std::string alternatives_markdown(const AlternativesInfo& alternatives) {
  std::string out = fmt::format("### A {}\n\n{} One of:\n\n", alternatives.name, alternatives.doc);
  for (const auto& one : alternatives.list) out += fmt::format("- `{}:` {}\n", one.name, one.words);
  if (!alternatives.later.empty())
    out += fmt::format("\nNames that the format has and this version does not render: `{}`.\n",
                       fmt::join(alternatives.later, "`, `"));
  return out + "\n";
}

template <class Part>
std::vector<Part> joined(std::vector<Part> a, const std::vector<Part>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace

std::string json_schema() {
  Members definitions, schema;
  for (const TableInfo* table : joined(scene_tables(), field_tables()))
    definitions.add(table->name, table_json(*table));
  for (const AlternativesInfo* list : joined(scene_alternatives(), field_alternatives()))
    definitions.add(list->name, alternatives_json(*list));
  schema.add("$schema", "\"http://json-schema.org/draft-07/schema#\"");
  schema.add("title", "\"Marrow scene\"");
  schema.add("allOf", fmt::format("[{}]", reference_to("scene")));
  schema.add("definitions", definitions.object());
  return indented(schema.object());
}

std::string schema_markdown() {
  std::string out;
  for (const TableInfo* table : scene_tables()) out += table_markdown(*table);
  for (const AlternativesInfo* list : scene_alternatives()) out += alternatives_markdown(*list);
  for (const AlternativesInfo* list : field_alternatives()) out += alternatives_markdown(*list);
  for (const TableInfo* table : field_tables()) out += table_markdown(*table);
  return out;
}

}  // namespace marrow
