// The table of objects, and of the shapes that are no fields.
#include "renderer/scene/object_forms.h"

#include "renderer/scene/field_forms.h"
#include "renderer/scene/files/mesh_file.h"

namespace marrow {
namespace {

const Table<PlaneShape>& plane_table() {
  static const Table<PlaneShape> table("plane", "An endless plane.",
                                       {key<PlaneShape>("point", &PlaneShape::point, position(), "a point of it"),
                                        key<PlaneShape>("normal", &PlaneShape::normal, direction(), "its upper side")});
  return table;
}

struct MeshFile {
  std::filesystem::path file;
};
const Table<MeshFile>& mesh_table() {
  static const Table<MeshFile> table(
      "mesh", "Triangles of a file.",
      {key<MeshFile>("file", &MeshFile::file, file_name(), "an .obj or .ply file, relative to this one").required()});
  return table;
}

Form<MeshShape> mesh() {
  const Form<MeshFile> map = map_of(mesh_table());
  Form<MeshShape> form = mapped<MeshShape>(map, [](const MeshFile&) { return MeshShape{}; });
  form.read = [map](const Value& v, Reader& reader) -> std::optional<MeshShape> {
    const auto wanted = map.read(v, reader);
    if (!wanted) return std::nullopt;
    const Place& at = v.find("file")->value.place;
    auto file = reader.open(wanted->file, at);
    if (!file) return std::nullopt;
    auto shape = read_mesh(file->bytes, wanted->file.string());
    if (shape) return std::move(*shape);
    reader.report_file(wanted->file, std::move(file->bytes), shape.why());
    return std::nullopt;
  };
  return form;
}

const Table<ObjectDescription>& object_table() {
  using Object = ObjectDescription;
  static const Table<Object> table = [] {
    Table<Object> made(
        "object", "Something to see.",
        {key<Object>("name", &Object::name,
                     checked(
                         name_of("a name"), [](const std::string& name) { return !name.empty(); },
                         "a name of one letter at least"),
                     "for masks, `probe` and overrides; \"object N\" when left out"),
         key<Object>("material", &Object::material, material_name(), "its material; matt grey when left out"),
         key<Object>("field", &Object::shape, field_tree(), "a surface grown on skeletons"),
         key<Object>("plane", &Object::shape, map_of(plane_table()), "an endless plane"),
         key<Object>("mesh", &Object::shape, mesh(), "triangles of a file")});
    made.info.exactly_one = {"field", "plane", "mesh"};
    return made;
  }();
  return table;
}

}  // namespace

Form<ObjectDescription> object() {
  Form<ObjectDescription> form = map_of(object_table());
  form.read = [](const Value& v, Reader& reader) -> std::optional<ObjectDescription> {
    auto object = object_table().read(v, reader);
    if (object) object->where = reader.sources.location(v.place);
    return object;
  };
  return form;
}

std::vector<const TableInfo*> object_tables() {
  return {&object_table().info, &plane_table().info, &mesh_table().info};
}

}  // namespace marrow
