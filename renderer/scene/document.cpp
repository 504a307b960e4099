// Builds the tree from yaml-cpp's events, which carry a place each and show anchors and duplicates.
#include "renderer/scene/document.h"

#include <map>
#include <sstream>
#include <utility>

#include <fmt/core.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include "renderer/scene/utf8.h"

namespace marrow {
namespace {

// Ends the parse after a mistake that leaves no sense in the rest; the diagnostic has been made.
struct Stop {};

class TreeBuilder final : public YAML::EventHandler {
 public:
  TreeBuilder(Place origin, const SourceCache& sources, std::size_t& values_left, Diagnostics& problems)
      : origin_(origin), sources_(sources), values_left_(values_left), problems_(problems) {}

  std::optional<Value> take_root() { return std::move(root_); }

  Place place(const YAML::Mark& mark) const {
    if (mark.is_null()) return {.file = origin_.file};
    const int column = mark.line == 0 ? origin_.column + mark.column : 1 + mark.column;
    return {.file = origin_.file, .line = origin_.line + mark.line, .column = column};
  }
  void report(const Place& at, std::string message, std::string hint, std::size_t length = 1) {
    problems_.push_back({.where = sources_.location(at),
                         .message = std::move(message),
                         .hint = std::move(hint),
                         .length = static_cast<int>(length)});
  }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (!root_) return;
    report(place(mark), "a second document starts here", "a scene is one document; remove what follows `---`");
    throw Stop{};
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { put(Value(Value::Kind::Absent, spend(mark))); }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t, const std::string& text) override {
    const Place at = spend(mark);
    check_tag(at, tag);
    put(Value(tag == "!" ? Value::Kind::Quoted : Value::Kind::Plain, at, text));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    open(mark, tag, Value::Kind::List);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t, YAML::EmitterStyle::value) override {
    open(mark, tag, Value::Kind::Map);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapEnd() override { close(); }
  void OnAnchor(const YAML::Mark& mark, const std::string& name) override {
    report(place(mark), "the anchor `&" + name + "` is not part of the scene format",
           "name the subtree under `defs:` and place it with `use: " + name + "`", name.size() + 1);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    const Place at = spend(mark);
    report(at, "an alias is not part of the scene format", "name the subtree under `defs:` and place it with `use:`");
    put(Value(Value::Kind::Broken, at));
  }

 private:
  struct Level {
    Value value;                        // the list or map that is being filled
    std::map<std::string, Place> keys;  // of a map: where each key stands first
    std::optional<Value> key;           // of a map: the key whose value comes next
    bool has_refused = false;           // of a map: whether a member was left out after a mistake
  };

  Place spend(const YAML::Mark& mark) {
    const Place at = place(mark);
    if (values_left_ > 0) return --values_left_, at;
    report(at, "the scene holds too many values", "keep large skeletons in files: `skeleton: {file: …}`");
    throw Stop{};
  }
  void check_tag(const Place& at, const std::string& tag) {
    if (tag.empty() || tag == "?" || tag == "!") return;
    report(at, "the tag `" + tag + "` is not part of the scene format", "remove it");
  }
  void open(const YAML::Mark& mark, const std::string& tag, Value::Kind kind) {
    const Place at = spend(mark);
    check_tag(at, tag);
    if (levels_.size() == static_cast<std::size_t>(max_nesting)) {
      report(at, "nested deeper than " + std::to_string(max_nesting) + " levels",
             "operators take any number of children in one list; name deep subtrees under `defs:` and place them with "
             "`use:`");
      throw Stop{};
    }
    levels_.push_back({.value = Value(kind, at), .keys = {}, .key = {}});
  }
  void close() {
    Value done = std::move(levels_.back().value);
    if (levels_.back().has_refused && done.members.empty()) done.kind = Value::Kind::Broken;
    levels_.pop_back();
    put(std::move(done));
  }

  void put(Value value) {
    if (levels_.empty()) root_ = std::move(value);
    else if (levels_.back().value.kind == Value::Kind::List) levels_.back().value.items.push_back(std::move(value));
    else if (!levels_.back().key) levels_.back().key = std::move(value);
    else put_member(levels_.back(), std::move(value));
  }
  void put_member(Level& level, Value value) {
    const Value key = std::move(*level.key);
    level.key.reset();
    level.has_refused = true;
    if (key.kind == Value::Kind::Broken) return;
    if (!key.is_scalar()) return report(key.place, "a key must be a word, found " + describe(key), "");
    if (key.text == "<<")
      return report(key.place, "the merge key `<<` is not part of the scene format",
                    "write the keys out, or name the subtree under `defs:` and place it with `use:`", 2);
    const auto [first, is_new] = level.keys.emplace(key.text, key.place);
    if (!is_new) {
      const SourceLocation where = sources_.location(first->second);
      return report(
          key.place, "`" + key.text + "` is given twice",
          "it stands first at " + where.file + ":" + std::to_string(where.line) + ":" + std::to_string(where.column),
          key.text.size());
    }
    level.has_refused = false;
    level.value.members.push_back({.key = key.text, .place = key.place, .value = std::move(value)});
  }

  Place origin_;
  const SourceCache& sources_;
  std::size_t& values_left_;
  Diagnostics& problems_;
  std::vector<Level> levels_;
  std::optional<Value> root_;
};

// Line `number` (from 0) of the text.
std::string_view line_at(std::string_view text, int number) {
  for (; number > 0 && !text.empty(); --number) text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  return text.substr(0, text.find('\n'));
}

// yaml-cpp stumbles over a tab one line late or at the tab, depending on what it expected.
std::string hint_for_syntax(std::string_view text, int line) {
  for (const int candidate : {line, line - 1}) {
    if (candidate < 0) continue;
    const std::string_view suspect = line_at(text, candidate);
    if (suspect.substr(0, suspect.find_first_not_of(" \t")).find('\t') != std::string_view::npos)
      return "YAML indents with spaces; there is a tab at the start of the line";
  }
  return "";
}

bool check_text(const YamlText& source, const SourceCache& sources, Diagnostics& problems) {
  const auto bad = first_invalid_utf8(source.text);
  if (!bad) return true;
  problems.push_back({.where = {.file = sources.name(source.origin.file), .line = bad->line, .column = bad->column},
                      .message = "this is not text: byte " + std::to_string(bad->offset) + " is not UTF-8",
                      .hint = "a scene is a YAML text in UTF-8"});
  return false;
}

}  // namespace

Value::Value(Kind kind_, Place place_, std::string text_) : kind(kind_), place(place_), text(std::move(text_)) {}

const Member* Value::find(std::string_view key) const {
  for (const Member& member : members)
    if (member.key == key) return &member;
  return nullptr;
}
Member* Value::find(std::string_view key) { return const_cast<Member*>(std::as_const(*this).find(key)); }

namespace {

// Short lists of scalars are shown as they are.
std::string describe_list(const Value& list) {
  std::string text;
  for (const Value& item : list.items) {
    if (!item.is_scalar() || text.size() > 40) return fmt::format("a list of {}", list.items.size());
    text += (text.empty() ? "" : ", ") + item.text;
  }
  return fmt::format("[{}]", text);
}

}  // namespace

std::string describe(const Value& value) {
  const auto shortened = [](const std::string& text) { return text.size() <= 60 ? text : text.substr(0, 57) + "..."; };
  switch (value.kind) {
    case Value::Kind::Absent:
      return "nothing";
    case Value::Kind::Plain:
      return fmt::format("`{}`", shortened(value.text));
    case Value::Kind::Quoted:
      return fmt::format("the text \"{}\"", shortened(value.text));
    case Value::Kind::List:
      return describe_list(value);
    case Value::Kind::Map:
      return "a map";
    case Value::Kind::Broken:
      break;
  }
  return "a broken value";
}

std::optional<Value> parse_yaml(const YamlText& source, const SourceCache& sources, std::size_t& values_left,
                                Diagnostics& problems) {
  if (!check_text(source, sources, problems)) return std::nullopt;
  TreeBuilder builder(source.origin, sources, values_left, problems);
  try {
    std::istringstream stream{std::string(source.text)};
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {}
  } catch (const Stop&) { return std::nullopt; } catch (const YAML::Exception& e) {
    builder.report(builder.place(e.mark), "not YAML: " + e.msg, hint_for_syntax(source.text, e.mark.line));
    return std::nullopt;
  }
  auto root = builder.take_root();
  return root ? std::move(root) : Value(Value::Kind::Absent, source.origin);
}

}  // namespace marrow
