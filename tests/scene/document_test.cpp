// The traps of YAML and of its parser.
#include "renderer/scene/document.h"

#include <string>

#include <gtest/gtest.h>

#include "renderer/scene/scalar.h"
#include "renderer/scene/suggestion.h"
#include "renderer/scene/utf8.h"

namespace marrow {
namespace {

struct Parsed {
  std::optional<Value> root;
  Diagnostics problems;
};

Parsed parse(std::string_view text, std::size_t budget = 1'000'000) {
  SourceCache sources;
  const Place origin{.file = sources.add("t.yaml", std::string(text)), .line = 1, .column = 1};
  Parsed parsed;
  parsed.root = parse_yaml({text, origin}, sources, budget, parsed.problems);
  return parsed;
}

void expect_problem(std::string_view text, int line, int column, std::string_view message) {
  const Parsed parsed = parse(text);
  ASSERT_EQ(parsed.problems.size(), 1u) << text;
  EXPECT_EQ(parsed.problems[0].where, (SourceLocation{"t.yaml", line, column})) << text;
  EXPECT_NE(parsed.problems[0].message.find(message), std::string::npos) << parsed.problems[0].message;
}

TEST(Document, EveryValueKnowsItsPlace) {
  const Parsed parsed = parse("a: 1\nb:\n  - x\n  - {c: \"y\"}\n");
  ASSERT_TRUE(parsed.root && parsed.problems.empty());
  const Value& y = parsed.root->find("b")->value.items[1].find("c")->value;
  EXPECT_EQ(y.kind, Value::Kind::Quoted);
  EXPECT_EQ(y.place.line, 4);
  EXPECT_EQ(y.place.column, 9);
}

TEST(Document, RefusesWhatTheFormatDoesNotHave) {
  expect_problem("a: 1\nb: 2\na: 3\n", 3, 1, "`a` is given twice");
  expect_problem("a: &x 1\n", 1, 4, "anchor `&x`");
  expect_problem("a: {<<: {b: 1}}\n", 1, 5, "merge key");
  expect_problem("a: !!int 1\n", 1, 4, "tag");
  expect_problem("[a, b]: 1\n", 1, 1, "a key must be a word");
  expect_problem("a: 1\n---\nb: 1\n", 2, 1, "second document");
  expect_problem("a: [1\nb: 2\n", 2, 2, "not YAML");
  expect_problem("a:\n\tb: 1\n", 2, 3, "not YAML");
  expect_problem(std::string_view("a: \0", 4), 1, 4, "not text");
  expect_problem("a: \xC0\x80", 1, 4, "not text");
}

TEST(Document, NestsToItsLimitAndNoFurther) {
  const auto nested = [](int depth) {
    const auto n = static_cast<std::size_t>(depth);
    return std::string(n, '[') + std::string(n, ']');
  };
  EXPECT_TRUE(parse(nested(max_nesting)).problems.empty());
  expect_problem(nested(max_nesting + 1), 1, max_nesting + 1, "nested deeper");
  const Parsed unclosed = parse(std::string(200000, '['));
  ASSERT_EQ(unclosed.problems.size(), 1u);
  EXPECT_NE(unclosed.problems[0].message.find("nested deeper"), std::string::npos);
}

TEST(Document, StopsAtItsBudget) {
  EXPECT_TRUE(parse("[1, 2, 3]", 4).root);
  const Parsed parsed = parse("[1, 2, 3]", 3);
  EXPECT_FALSE(parsed.root);
  EXPECT_EQ(parsed.problems.size(), 1u);
}

TEST(Document, JsonIsYaml) {
  const Parsed parsed = parse("{\"a\": [1, true, null, \"t\"]}");
  ASSERT_TRUE(parsed.root && parsed.problems.empty());
  EXPECT_EQ(parsed.root->find("a")->value.items[2].kind, Value::Kind::Absent);
}

TEST(Number, IsOfYaml12AndFinite) {
  for (const auto& [text, value] : std::initializer_list<std::pair<const char*, double>>{{"0", 0},
                                                                                         {"-1", -1},
                                                                                         {"+2.5", 2.5},
                                                                                         {".5", 0.5},
                                                                                         {"3.", 3},
                                                                                         {"1e3", 1000},
                                                                                         {"-0.0E-2", 0},
                                                                                         {"0x1F", 31},
                                                                                         {"0o17", 15}})
    EXPECT_EQ(parse_number(text), value) << text;
  for (const char* text :
       {"",   "-",  ".",   "010", "-007", "1_000", "1:30", "0b1",  "nan", ".nan", "inf",   "-.inf",   "1e999",
        "1e", "e5", "1 2", " 1",  "1,5",  "0x",    "0xG",  "0x-1", "--1", "+-1",  "1.2.3", "infinity"})
    EXPECT_FALSE(parse_number(text)) << text;
  EXPECT_EQ(parse_unsigned("18446744073709551615"), UINT64_MAX);
  for (const char* text : {"18446744073709551616", "-1", "64.0", "1e3", "010"})
    EXPECT_FALSE(parse_unsigned(text)) << text;
}

TEST(Number, ReadsBackWhatItPrints) {
  for (const double x : {0.1, 1.0 / 3, 1e-300, 1.7976931348623157e308, -5e-324 * 8, 123456789.125})
    EXPECT_EQ(parse_number(number_text(x)).value_or(0), x) << number_text(x);
}

TEST(Suggestion, CountsEdits) {
  EXPECT_EQ(edit_distance("bledn", "blend"), 1);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(nearest("raduis", {"at", "radius"}), "radius");
  EXPECT_FALSE(nearest("samples", {"spp", "seed"}));
}

TEST(Utf8, FindsTheFirstBadByte) {
  EXPECT_FALSE(first_invalid_utf8("Zürich → 𝛼\t\r\n"));
  for (const std::string_view bad :
       {"\x80", "\xC3", "\xE0\x80\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xFF", "\x1B"})
    EXPECT_TRUE(first_invalid_utf8(bad));
  const auto place = first_invalid_utf8("a\nbc\xFF");
  ASSERT_TRUE(place);
  EXPECT_EQ(place->line, 2);
  EXPECT_EQ(place->column, 3);
}

}  // namespace
}  // namespace marrow
