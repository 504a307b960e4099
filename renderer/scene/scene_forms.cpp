// The scene and its settings as tables.
#include "renderer/scene/scene_forms.h"

#include "renderer/scene/field_forms.h"
#include "renderer/scene/light_forms.h"
#include "renderer/scene/material_forms.h"
#include "renderer/scene/object_forms.h"

namespace marrow {
namespace {

bool check_camera(const CameraDescription& camera, const Value& v, Reader& reader) {
  const Vec3d forward = camera.to - camera.from;
  if (forward == Vec3d{}) reader.error(v.place, "the camera looks nowhere: `from` and `to` are equal");
  else if (cross(normalize(forward).vec(), normalize(camera.up).vec()) == Vec3d{})
    reader.error(v.place, "the camera looks along its `up`", "choose an `up` that points elsewhere, such as [0, 0, 1]");
  else return true;
  return false;
}

const Table<CameraDescription>& camera_table() {
  using Camera = CameraDescription;
  static const Table<Camera> table(
      "camera", "Looks from one point to another.",
      {key<Camera>("type", &Camera::type,
                   choice<Camera::Type>(
                       {{"perspective", Camera::Type::Perspective}, {"orthographic", Camera::Type::Orthographic}}),
                   "the projection"),
       key<Camera>("from", &Camera::from, position(),
                   "where it stands: outside bodies or inside them, not on a surface"),
       key<Camera>("to", &Camera::to, position(), "where it looks"),
       key<Camera>("up", &Camera::up, direction(), "what is up in the picture"),
       key<Camera>("fov", &Camera::fov_deg, degrees(between(0.001, 179)), "vertical angle of view, perspective only"),
       key<Camera>("height", &Camera::height, number(any_radius()),
                   "of the picture in scene units, orthographic only")},
      check_camera);
  return table;
}

const Table<FilmDescription>& film_table() {
  using Film = FilmDescription;
  const auto set_size = [](Film& film, const std::vector<int>& size) {
    film.width = size[0];
    film.height = size[1];
  };
  // 2^15 a side, so that a picture has at most 2^30 pixels.
  static const Table<Film> table("film", "The picture.",
                                 {key<Film>("size", set_size, list_of(integer(1, 32768), 2, 2),
                                            "width and height in pixels; [1280, 720] when left out")});
  return table;
}

const Table<RenderSettings>& render_table() {
  using Render = RenderSettings;
  using Integrator = RenderSettings::Integrator;
  static const Table<Render> table(
      "render", "How light is computed.",
      {key<Render>("integrator", &Render::integrator,
                   choice<Integrator>({{"path", Integrator::Path},
                                       {"direct", Integrator::Direct},
                                       {"normals", Integrator::Normals},
                                       {"depth", Integrator::Depth}}),
                   "path tracing, direct light only, or a picture of normals or depth: f / (f + depth), f from `from` "
                   "to `to` of "
                   "the camera"),
       key<Render>("spp", &Render::samples_per_pixel, integer(1, 1 << 24), "samples for each pixel"),
       key<Render>("seed", &Render::seed, any_unsigned(), "another seed gives other noise"),
       key<Render>("max_depth", &Render::max_depth, integer(1, 10000),
                   "surfaces along a path that may scatter; 1 is direct light only")});
  return table;
}

// Both are merged or read before the table is: see include.h and read_scene.cpp.
Form<bool> includes() {
  return either<bool>({mapped<bool>(file_name(), [](const auto&) { return true; }),
                       mapped<bool>(list_of(file_name(), 1), [](const auto&) { return true; })},
                      "the name of a file, or a list of such names");
}
Form<bool> definitions() {
  Form<bool> form = mapped<bool>(names_of(field_node()), [](const auto&) { return true; });
  form.read = [](const Value&, Reader&) { return std::optional(true); };
  return form;
}
template <class Owner>
Key<Owner> read_before(std::string name, const Form<bool>& form, std::string doc) {
  return key<Owner>(
      std::move(name), [](Owner&, bool) {}, form, std::move(doc));
}

const Form<int>& version() {
  static const Form<int> form = [] {
    Form<int> one = integer(1, 1);
    one.words = "1, the version of the format that this program reads";
    one.read = [read = one.read, words = one.words](const Value& v, Reader& reader) -> std::optional<int> {
      return v.kind == Value::Kind::Plain && v.text == "1" ? std::optional(1) : reader.wrong(v, words);
    };
    return one;
  }();
  return form;
}

struct IncludedFile {
  int version = 1;
};
const Table<IncludedFile>& included_file_table() {
  using File = IncludedFile;
  static const Table<File> table(
      "included_file", "A file that `include:` names.",
      {key<File>("marrow", &File::version, version(), "version of the format"),
       read_before<File>("include", includes(), "further files"),
       read_before<File>("materials", mapped<bool>(names_of(material()), [](const auto&) { return true; }),
                         "added to the scene's"),
       read_before<File>("defs", definitions(), "added to the scene's")});
  return table;
}

}  // namespace

const Table<SceneDraft>& scene_table() {
  using Scene = SceneDraft;
  static const Table<Scene> table(
      "scene", "The whole file.",
      {key<Scene>("marrow", &Scene::version, version(), "a scene begins with `marrow: 1`").required(),
       read_before<Scene>("include", includes(), "files whose `defs` and `materials` are added"),
       key<Scene>("units", &Scene::units, text(),
                  "what a length of 1 is, for the axes of slices and the headers of files only"),
       key<Scene>("up", &Scene::z_up, choice<bool>({{"y", false}, {"z", true}}),
                  "the axis that points up, for images and panels of light; the camera has its own"),
       key<Scene>("camera", &Scene::camera, map_of(camera_table()), "who looks"),
       key<Scene>("film", &Scene::film, map_of(film_table()), "the picture"),
       key<Scene>("render", &Scene::render, map_of(render_table()), "how light is computed"),
       key<Scene>("lights", &Scene::lights, list_of(light()), "what shines"),
       key<Scene>("materials", &Scene::materials, material_list(), "by name, for objects and skeletons"),
       read_before<Scene>("defs", definitions(), "field nodes by name, for `use:`"),
       key<Scene>("objects", &Scene::objects, list_of(object()), "what is there to see")});
  return table;
}

const TableInfo& included_file_info() { return included_file_table().info; }

std::vector<const TableInfo*> scene_tables() {
  std::vector<const TableInfo*> tables{&scene_table().info, &camera_table().info, &film_table().info,
                                       &render_table().info};
  for (const auto& part : {light_tables(), material_tables(), object_tables()})
    tables.insert(tables.end(), part.begin(), part.end());
  tables.push_back(&included_file_info());
  return tables;
}

std::vector<const AlternativesInfo*> scene_alternatives() { return {&light_alternatives(), &material_alternatives()}; }

}  // namespace marrow
