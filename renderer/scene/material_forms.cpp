// One table for each material.
#include "renderer/scene/material_forms.h"

#include "materials/metals.h"
#include "renderer/scene/colour.h"

namespace marrow {
namespace {

Form<std::string> metal_name() {
  std::vector<std::pair<std::string, std::string>> names;
  for (const std::string_view name : metal_names()) names.emplace_back(name, name);
  return choice<std::string>(names);
}

const Table<DiffuseDescription>& diffuse_table() {
  using Diffuse = DiffuseDescription;
  static const Table<Diffuse> table(
      "diffuse", "Matt, the same from all sides.",
      {key<Diffuse>("color", &Diffuse::color, albedo(), "part of the light that returns"),
       key<Diffuse>("emission", &Diffuse::emission, radiance(), "radiance that the surface sends out itself")});
  return table;
}

const Table<ConductorDescription>& conductor_table() {
  using Conductor = ConductorDescription;
  static const Table<Conductor> table(
      "conductor", "A metal with measured index of refraction.",
      {key<Conductor>("metal", &Conductor::metal, metal_name(), "which metal"),
       key<Conductor>("roughness", &Conductor::roughness, number(between(0, 1)), "0 is a mirror, 1 is satin")});
  return table;
}

const Table<CoatedDescription>& coated_table() {
  using Coated = CoatedDescription;
  static const Table<Coated> table(
      "coated", "A matt colour under a clear coat.",
      {key<Coated>("color", &Coated::color, albedo(), "of what lies under the coat"),
       key<Coated>("roughness", &Coated::roughness, number(between(0, 1)), "of the coat"),
       key<Coated>("ior", &Coated::ior, number(between(1.01, 3)), "index of refraction of the coat")});
  return table;
}

template <class Description>
Form<MaterialDescription> any(const Table<Description>& table) {
  return mapped<MaterialDescription>(map_of(table), [](Description d) { return MaterialDescription(std::move(d)); });
}

const Alternatives<MaterialDescription>& materials() {
  static const Alternatives<MaterialDescription> materials(
      "material", "How a surface scatters light.",
      {{"diffuse", any(diffuse_table())}, {"conductor", any(conductor_table())}, {"coated", any(coated_table())}});
  return materials;
}

}  // namespace

Form<MaterialDescription> material() { return one_of(materials()); }

Form<std::vector<NamedMaterial>> material_list() {
  const auto named = names_of(material());
  Form<std::vector<NamedMaterial>> form =
      mapped<std::vector<NamedMaterial>>(named, [](const auto&) { return std::vector<NamedMaterial>{}; });
  form.read = [named](const Value& v, Reader& reader) -> std::optional<std::vector<NamedMaterial>> {
    auto read = named.read(v, reader);
    if (!read) return std::nullopt;
    std::vector<NamedMaterial> list;
    for (auto& [name, what, place] : *read)
      list.push_back({std::move(name), std::move(what), reader.sources.location(place)});
    return list;
  };
  return form;
}

std::vector<const TableInfo*> material_tables() {
  return {&diffuse_table().info, &conductor_table().info, &coated_table().info, &kelvin_table_info()};
}
const AlternativesInfo& material_alternatives() { return materials().info; }

}  // namespace marrow
