// Includes are merged as values before anything is read, so that readers know nothing of them.
#include "renderer/scene/include.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

#include "renderer/scene/scene_forms.h"

namespace marrow {
namespace {

constexpr std::size_t max_depth = 16;

class Includer {
 public:
  Includer(Value& scene, Reader& reader, TextBudget& budget) : scene_(scene), reader_(reader), budget_(budget) {}

  /// The files that `text` includes. `path` leads from the scene to the file that `text` is of.
  void follow(const Value& text, std::vector<std::filesystem::path>& path) {
    const Member* include = text.find("include");
    if (!include) return;
    const Value& named = include->value;
    if (named.kind != Value::Kind::List) return merge_file(named, path);
    for (const Value& name : named.items) merge_file(name, path);
  }

 private:
  void merge_file(const Value& name, std::vector<std::filesystem::path>& path) {
    if (!name.is_scalar() || name.text.empty()) return;  // reported by the table of the file
    if (path.size() > max_depth) return reader_.error(name.place, "files include each other more than 16 deep");
    std::filesystem::path canonical;
    const std::size_t before = reader_.problems.size();
    auto text = read_text(reader_.resolve(name.text, name.place), name.place, reader_, budget_, canonical);
    if (std::find(path.begin(), path.end(), canonical) != path.end()) {
      reader_.problems.resize(before);  // the circle is the one mistake to tell
      return reader_.error(name.place, "`" + name.text + "` includes itself",
                           "an include must not lead back to its file", name.text.size());
    }
    if (!text || !merged_.insert(canonical).second) return;
    const Subject subject(reader_, "an included file");
    bool complete = true;
    if (!check_members(included_file_info(), *text, reader_, complete)) return;
    path.push_back(canonical);
    follow(*text, path);
    path.pop_back();
    for (const char* key : {"materials", "defs"}) merge_map(key, *text);
  }

  void merge_map(const char* key, Value& from) {
    Member* source = from.find(key);
    if (!source) return;
    Member* target = scene_.find(key);
    if (!target) {
      scene_.members.push_back(std::move(*source));
      return;
    }
    if (source->value.kind != Value::Kind::Map) {
      reader_.wrong(source->value, "a map");
      return;
    }
    for (Member& member : source->value.members) {
      if (const Member* known = target->value.find(member.key)) {
        const SourceLocation where = reader_.sources.location(known->place);
        reader_.error(member.place, "`" + member.key + "` of `" + key + "` is given twice",
                      "it stands also at " + where.file + ":" + std::to_string(where.line), member.key.size());
      } else target->value.members.push_back(std::move(member));
    }
  }

  Value& scene_;
  Reader& reader_;
  TextBudget& budget_;
  std::set<std::filesystem::path> merged_;
};

}  // namespace

std::optional<Value> read_text(const std::filesystem::path& path, const Place& at, Reader& reader, TextBudget& budget,
                               std::filesystem::path& canonical) {
  if (budget.files == 0) {
    reader.error(at, "the scene includes more than 1000 files");
    return std::nullopt;
  }
  --budget.files;
  auto file = reader.files.read(path, budget.bytes);
  if (!file) {
    for (const Diagnostic& d : file.why()) reader.error(at, d.message, d.hint);
    return std::nullopt;
  }
  budget.bytes -= std::min<std::uint64_t>(budget.bytes, file->bytes.size());
  canonical = file->canonical;
  if (file->bytes.starts_with("\xEF\xBB\xBF")) file->bytes.erase(0, 3);  // byte order mark
  const std::uint32_t source = reader.sources.add(path.string(), std::move(file->bytes));
  const YamlText text{reader.sources.text(path.string()), {.file = source, .line = 1, .column = 1}};
  return parse_yaml(text, reader.sources, budget.values, reader.problems);
}

void merge_includes(Value& scene, const std::filesystem::path& canonical, Reader& reader, TextBudget& budget) {
  Value as_written(Value::Kind::Map);  // a copy, because merging adds to the scene's own members
  if (const Member* include = scene.find("include")) as_written.members.push_back(*include);
  std::vector<std::filesystem::path> path{canonical};
  Includer(scene, reader, budget).follow(as_written, path);
}

}  // namespace marrow
