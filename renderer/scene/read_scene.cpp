// The steps from a file to a description: parse, include, override, define, read, join.
#include "renderer/scene/read_scene.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "renderer/scene/files/skeleton_file.h"
#include "renderer/scene/include.h"
#include "renderer/scene/override.h"
#include "renderer/scene/reader.h"
#include "renderer/scene/scene_forms.h"

namespace marrow {
namespace {

// Subtrees name materials and objects name subtrees, so names of materials and all subtrees come first. A material
// with mistakes keeps its name, so that what names it is not a second mistake.
std::optional<SceneDraft> read_values(const Value& scene, Reader& reader) {
  if (const Member* materials = scene.find("materials"))
    for (const Member& member : materials->value.members) reader.materials.push_back(member.key);
  if (const Member* defs = scene.find("defs")) {
    const Subject subject(reader, "`defs`");
    if (defs->value.kind == Value::Kind::Map) reader.definitions.read(defs->value, reader);
    else reader.wrong(defs->value, "a map from names to nodes");
  }
  return scene_table().read(scene, reader);
}

std::string default_name(std::size_t i) { return "object " + std::to_string(i + 1); }

// Asked of the text, so that it is told together with what is wrong with the objects themselves.
void check_object_names(const Value& scene, Reader& reader) {
  const Member* objects = scene.find("objects");
  if (objects == nullptr) return;
  std::map<std::string, Place> first;
  const auto& items = objects->value.items;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const Member* given = items[i].find("name");
    const bool is_named = given != nullptr && given->value.is_scalar() && !given->value.text.empty();
    const std::string name = is_named ? given->value.text : default_name(i);
    const Place place = is_named ? given->value.place : items[i].place;
    const auto [known, is_new] = first.emplace(name, place);
    if (is_new) continue;
    const SourceLocation there = reader.sources.location(known->second);
    reader.error(place, "two objects are called `" + name + "`",
                 "the first stands at " + there.file + ":" + std::to_string(there.line), is_named ? name.size() : 1);
  }
}

void name_objects(std::vector<ObjectDescription>& objects) {
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (objects[i].name.empty()) objects[i].name = default_name(i);
}

// Objects that name no material share a matt grey one.
void complete_materials(SceneDraft& draft) {
  MaterialId grey;
  for (ObjectDescription& object : draft.objects) {
    if (object.material.valid()) continue;
    if (!grey.valid()) {
      grey = MaterialId{draft.materials.size()};
      draft.materials.push_back({.name = "default", .what = DiffuseDescription{}, .where = {}});
    }
    object.material = grey;
  }
}

// Definitions number what they place; only what stands in several objects is shared among them.
void keep_what_is_shared(std::vector<ObjectDescription>& objects) {
  std::unordered_map<std::size_t, int> fields;
  const auto for_each_node = [&](const auto& visit) {
    for (ObjectDescription& object : objects)
      if (auto* field = std::get_if<FieldDescription>(&object.shape))
        std::for_each(field->nodes.begin(), field->nodes.end(), visit);
  };
  for_each_node([&](FieldNode& node) { ++fields[node.shared]; });
  for_each_node([&](FieldNode& node) {
    if (fields[node.shared] < 2) node.shared = 0;
  });
}

SceneDescription finished(SceneDraft draft, std::string hash) {
  return {.units = std::move(draft.units),
          .z_up = draft.z_up,
          .camera = draft.camera,
          .film = draft.film,
          .render = draft.render,
          .lights = std::move(draft.lights),
          .materials = std::move(draft.materials),
          .objects = std::move(draft.objects),
          .hash = std::move(hash)};
}

void sort_by_place(Diagnostics& problems) {
  std::map<std::string, std::size_t> file_order;  // files in the order in which they are first spoken of
  for (const Diagnostic& d : problems) file_order.emplace(d.where.file, file_order.size());
  std::stable_sort(problems.begin(), problems.end(), [&](const Diagnostic& a, const Diagnostic& b) {
    return std::tuple(file_order[a.where.file], a.where.line, a.where.column) <
           std::tuple(file_order[b.where.file], b.where.line, b.where.column);
  });
}

std::optional<SceneDescription> read_all(const std::filesystem::path& path, const ReadOptions& options,
                                         Reader& reader) {
  const std::string name = path.filename().string();
  if (skeleton_format_of(name) && std::filesystem::exists(path)) {
    reader.problems.push_back(with_hint(failure("this is a skeleton, not a scene", path.string()),
                                        "a scene names it by `skeleton: {file: " + name + "}`"));
    return std::nullopt;
  }
  TextBudget budget;
  std::filesystem::path canonical;
  auto scene = read_text(path, {.file = UINT32_MAX}, reader, budget, canonical);
  if (!scene) return std::nullopt;
  if (scene->kind == Value::Kind::Absent) {
    reader.error(scene->place, "the file holds no scene", "a scene starts with `marrow: 1`");
    return std::nullopt;
  }
  if (!options.allow_outside) reader.files.confine_to(path.parent_path());
  merge_includes(*scene, canonical, reader, budget);
  apply_overrides(*scene, options.overrides, reader, budget.values);
  check_object_names(*scene, reader);
  auto draft = read_values(*scene, reader);
  if (!draft) return std::nullopt;
  name_objects(draft->objects);
  complete_materials(*draft);
  keep_what_is_shared(draft->objects);
  return finished(*std::move(draft), reader.files.hash());
}

}  // namespace

Result<SceneDescription> read_scene(const std::filesystem::path& path, const ReadOptions& options, ReadRecord& record) {
  InputFiles files;
  Reader reader(record.sources, files, path.parent_path());
  auto scene = read_all(path, options, reader);
  record.warnings = std::move(reader.warnings);
  record.files = files.names();
  sort_by_place(reader.problems);
  if (scene && reader.problems.empty()) return *std::move(scene);
  return std::move(reader.problems);
}

Result<SceneDescription> read_scene(const std::filesystem::path& path, const ReadOptions& options) {
  ReadRecord record;
  return read_scene(path, options, record);
}

}  // namespace marrow
