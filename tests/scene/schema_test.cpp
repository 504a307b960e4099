// What the tables promise, they hold; and the reference in docs is theirs.
#include "renderer/scene/schema.h"

#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/scene/field_forms.h"
#include "renderer/scene/scene_forms.h"
#include "tests/source_folder.h"

namespace marrow {
namespace {

std::vector<const TableInfo*> all_tables() {
  auto tables = scene_tables();
  for (const TableInfo* table : field_tables()) tables.push_back(table);
  return tables;
}

TEST(Schema, EveryReferenceHasItsDefinition) {
  const std::string schema = json_schema();
  std::set<std::string> defined;
  for (const TableInfo* table : all_tables()) EXPECT_TRUE(defined.insert(table->name).second) << table->name;
  for (const auto& lists : {scene_alternatives(), field_alternatives()})
    for (const AlternativesInfo* list : lists) EXPECT_TRUE(defined.insert(list->name).second) << list->name;
  const std::string mark = "#/definitions/";
  std::set<std::string> used;
  for (auto at = schema.find(mark); at != std::string::npos; at = schema.find(mark, at + 1))
    used.insert(schema.substr(at + mark.size(), schema.find('"', at) - at - mark.size()));
  for (const std::string& name : used) EXPECT_TRUE(defined.contains(name)) << name;
  defined.erase("included_file");  // stands alone
  EXPECT_EQ(used, defined);
}

TEST(Schema, EveryKeyIsDescribed) {
  for (const TableInfo* table : all_tables()) {
    EXPECT_FALSE(table->doc.empty()) << table->name;
    for (const KeyInfo& key : table->keys)
      EXPECT_TRUE(!key.doc.empty() && !key.words.empty() && !key.json.empty()) << table->name << "." << key.name;
  }
}

TEST(Schema, TheReferenceInDocsIsCurrent) {
  std::ostringstream text;
  text << std::ifstream(test::source_folder() + "/docs/scene-format.md").rdbuf();
  const std::string begin = "<!-- reference: begin -->\n", end = "<!-- reference: end -->";
  const auto from = text.str().find(begin), to = text.str().find(end);
  ASSERT_TRUE(from != std::string::npos && to != std::string::npos);
  EXPECT_EQ(text.str().substr(from + begin.size(), to - from - begin.size()), schema_markdown())
      << "scene_tool refresh docs/scene-format.md";
}

}  // namespace
}  // namespace marrow
