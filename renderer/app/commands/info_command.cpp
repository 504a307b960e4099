// marrow info: what a scene is made of, and what it becomes for tracing.
#include <array>
#include <cstddef>
#include <map>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "field/base/overloaded.h"
#include "field/blend/blend_field.h"
#include "renderer/app/command_line/commands.h"
#include "renderer/app/input/scene_input.h"
#include "renderer/app/report/report.h"
#include "renderer/app/text/print.h"
#include "renderer/app/text/text.h"
#include "renderer/geometry/build_surfaces.h"
#include "renderer/geometry/tree_parts.h"

namespace marrow {
namespace {

using Json = nlohmann::ordered_json;

Json corners(const Box3& box) {
  if (box.empty()) return nullptr;
  return {{"lower", {box.lower.x, box.lower.y, box.lower.z}}, {"upper", {box.upper.x, box.upper.y, box.upper.z}}};
}

const char* kind_of(const LightDescription& light) {
  return std::visit(
      Overloaded{[](const ConstantLight&) { return "constant"; }, [](const ImageLight&) { return "image"; },
                 [](const SunLight&) { return "sun"; }, [](const RectangleLight&) { return "rectangle"; },
                 [](const PointLight&) { return "point"; }},
      light.what);
}

const char* kind_of(const MaterialDescription& material) {
  return std::visit(Overloaded{[](const DiffuseDescription&) { return "diffuse"; },
                               [](const ConductorDescription&) { return "conductor"; },
                               [](const CoatedDescription&) { return "coated"; }},
                    material);
}

// What does not go through the tracer of blends, and why: what is slow of a scene is found here.
Json general_parts(const FieldProgram& surface) {
  std::map<std::string, std::size_t> reasons;
  for (const PlacedBlend& part : surface.parts())
    if (const std::string reason = untraceable_part(part.blend); !reason.empty()) ++reasons[reason];
  for (const FieldTree& tree : surface.trees())
    if (take_apart(tree).rest) ++reasons["operators, warps and bounded primitives"];
  Json parts = Json::array();
  for (const auto& [reason, count] : reasons) parts.push_back({{"parts", count}, {"because", reason}});
  return parts;
}

// Blends alone are their own surface.
Json general_parts(const FieldProgram& program, const FieldDescription& field) {
  if (program.trees().empty()) return general_parts(program);
  const auto surface = compile_surface(field);
  return surface ? general_parts(*surface) : Json::array();
}

Json object_info(const ObjectDescription& object, const FieldObject* field) {
  Json info{{"name", object.name}};
  std::visit(Overloaded{[&](const FieldDescription& description) {
                          info["kind"] = "field";
                          info["primitives"] = field ? primitive_count(field->program) : 0;
                          info["blends"] = field ? field->program.parts().size() : 0;
                          info["extent"] = field ? corners(extent(field->program)) : nullptr;
                          info["general_tracer"] = field ? general_parts(field->program, description) : Json::array();
                        },
                        [&](const PlaneShape&) { info["kind"] = "plane"; },
                        [&](const MeshShape& mesh) {
                          info["kind"] = "mesh";
                          info["triangles"] = mesh.triangles.size();
                        }},
             object.shape);
  return info;
}

Json scene_info(const SceneInput& input, const LoadedScene& scene, const Surfaces& surfaces) {
  const auto& d = scene.description;
  Json info{{"scene", input.path.string()}, {"hash", d.hash}, {"units", d.units}};
  info["film"] = {d.film.width, d.film.height};
  info["objects"] = Json::array();
  for (std::size_t i = 0; i < d.objects.size(); ++i) {
    const FieldObject* field = nullptr;
    for (const auto& candidate : scene.fields)
      if (candidate.object == ObjectId{i}) field = &candidate;
    info["objects"].push_back(object_info(d.objects[i], field));
  }
  info["materials"] = Json::array();
  for (const auto& m : d.materials) info["materials"].push_back({{"name", m.name}, {"kind", kind_of(m.what)}});
  info["lights"] = Json::array();
  for (const auto& light : d.lights) info["lights"].push_back(kind_of(light));
  const SurfaceReport built = report(surfaces);
  info["primitives"] = built.primitives;
  info["tiles"] = built.tiles;
  info["memory_bytes"] = built.bytes;
  info["build_seconds"] = built.build_seconds;
  info["bounds"] = corners(surfaces.bounds());
  return info;
}

std::string memory_text(std::size_t bytes) {
  constexpr std::array units{"B", "KiB", "MiB", "GiB"};
  double amount = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; amount >= 1024 && unit + 1 < units.size(); ++unit) amount /= 1024;
  return fmt::format("{:.{}f} {}", amount, unit == 0 ? 0 : 1, units[unit]);
}

std::string box_text(const Json& box) {
  if (box.is_null()) return "none";
  const auto corner = [&](const char* name) {
    const auto& c = box[name];
    return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", c[0].get<double>(), c[1].get<double>(), c[2].get<double>());
  };
  return corner("lower") + " to " + corner("upper");
}

std::string object_text(const Json& object) {
  std::string text = fmt::format("  {:<12} {}", object["name"].get<std::string>(), object["kind"].get<std::string>());
  if (object.contains("primitives"))
    text += fmt::format(", {} in {}, {}", counted(object["primitives"].get<std::size_t>(), "primitive"),
                        counted(object["blends"].get<std::size_t>(), "blend"), box_text(object["extent"]));
  if (object.contains("general_tracer"))
    for (const Json& part : object["general_tracer"])
      text += fmt::format("\n  {:<12} {} of its parts in the general tracer, which is slower: {}", "",
                          part["parts"].get<std::size_t>(), part["because"].get<std::string>());
  if (object.contains("triangles")) text += ", " + counted(object["triangles"].get<std::size_t>(), "triangle");
  return text + '\n';
}

std::string text_of(const Json& info) {
  std::string text = fmt::format("scene       {}\nhash        {}\nfilm        {} x {}\nobjects     {}\n",
                                 info["scene"].get<std::string>(), info["hash"].get<std::string>(),
                                 info["film"][0].get<int>(), info["film"][1].get<int>(), info["objects"].size());
  for (const auto& object : info["objects"]) text += object_text(object);
  text += fmt::format("materials   {}\n", info["materials"].size());
  for (const auto& material : info["materials"])
    text += fmt::format("  {:<12} {}\n", material["name"].get<std::string>(), material["kind"].get<std::string>());
  text += fmt::format("lights      {}\n", info["lights"].size());
  for (const auto& light : info["lights"]) text += fmt::format("  {}\n", light.get<std::string>());
  text += fmt::format("primitives  {}\ntiles       {}\nmemory      {}\nbounds      {}\nbuilt in    {:.3f} s\n",
                      info["primitives"].get<std::size_t>(), info["tiles"].get<std::size_t>(),
                      memory_text(info["memory_bytes"].get<std::size_t>()), box_text(info["bounds"]),
                      info["build_seconds"].get<double>());
  return text;
}

}  // namespace

ExitCode run(const InfoCommand& command) {
  ReadRecord record;
  const auto scene = load_and_report(command.scene, record);
  if (!scene) return exit_code_of_failed_load(command.scene);
  const auto surfaces = build_surfaces(scene->description, {.isa = {}, .threads = command.threads});
  if (!surfaces) return report(surfaces.why(), record.sources, ExitCode::BadInput);
  const Json info = scene_info(command.scene, *scene, **surfaces);
  say(command.json ? info.dump(2, ' ', false, Json::error_handler_t::replace) + '\n' : text_of(info));
  return ExitCode::Ok;
}

}  // namespace marrow
