// One table for each light.
#include "renderer/scene/light_forms.h"

#include "renderer/scene/colour.h"

namespace marrow {
namespace {

using AnyLight = decltype(LightDescription::what);

const Table<ConstantLight>& constant_table() {
  static const Table<ConstantLight> table(
      "constant", "The same light from everywhere.",
      {key<ConstantLight>("radiance", &ConstantLight::radiance, radiance(), "from each direction")});
  return table;
}

const Table<ImageLight>& image_table() {
  static const Table<ImageLight> table(
      "image",
      "A picture of all directions (latitude-longitude) that shines: its first row is up, its middle "
      "looks to -z, or to y where z is up.",
      {key<ImageLight>("file", &ImageLight::file, file_name(), "OpenEXR or another linear picture").required(),
       key<ImageLight>("rotate", &ImageLight::rotate_deg, degrees(any_number()), "about the up axis, in degrees"),
       key<ImageLight>("scale", &ImageLight::scale, radiance(), "multiplies the picture")});
  return table;
}

const Table<SunLight>& sun_table() {
  static const Table<SunLight> table(
      "sun", "A far disc of light.",
      {key<SunLight>("direction", &SunLight::direction, direction(), "from the scene toward the sun"),
       key<SunLight>("irradiance", &SunLight::irradiance, radiance(), "on a surface that faces it"),
       key<SunLight>("angle", &SunLight::angle_deg, degrees({.min = 0, .max = 180}),
                     "diameter of the disc in degrees")});
  return table;
}

const Table<RectangleLight>& rectangle_table() {
  const auto set_size = [](RectangleLight& light, const std::vector<double>& size) {
    light.width = size[0];
    light.height = size[1];
  };
  static const Table<RectangleLight> table(
      "rectangle", "A panel that shines to one side.",
      {key<RectangleLight>("center", &RectangleLight::center, position(), "its middle").required(),
       key<RectangleLight>("normal", &RectangleLight::normal, direction(), "the side that shines"),
       key<RectangleLight>("size", set_size, list_of(number(any_radius()), 2, 2),
                           "width and height; [1, 1] when left out"),
       key<RectangleLight>("radiance", &RectangleLight::radiance, radiance(), "of the panel")});
  return table;
}

const Table<PointLight>& point_light_table() {
  static const Table<PointLight> table(
      "point_light", "Light from a point, the same to all sides. Written `point:` among the lights.",
      {key<PointLight>("at", &PointLight::position, position(), "where").required(),
       key<PointLight>("intensity", &PointLight::intensity, radiance(), "per steradian")});
  return table;
}

template <class Light>
Form<AnyLight> any(const Table<Light>& table) {
  return mapped<AnyLight>(map_of(table), [](Light light) { return AnyLight(std::move(light)); });
}

// The picture is decoded later; here it must be readable, and its bytes belong to the scene's hash.
Form<AnyLight> image() {
  Form<AnyLight> form = any(image_table());
  form.read = [read = form.read](const Value& v, Reader& reader) -> std::optional<AnyLight> {
    const auto light = read(v, reader);
    if (light && !reader.open(std::get<ImageLight>(*light).file, v.find("file")->value.place)) return std::nullopt;
    return light;
  };
  return form;
}

const Alternatives<AnyLight>& lights() {
  static const Alternatives<AnyLight> lights("light", "One light.",
                                             {{"constant", any(constant_table())},
                                              {"image", image()},
                                              {"sun", any(sun_table())},
                                              {"rectangle", any(rectangle_table())},
                                              {"point", any(point_light_table())}});
  return lights;
}

}  // namespace

Form<LightDescription> light() {
  const Form<AnyLight> what = one_of(lights());
  Form<LightDescription> form = mapped<LightDescription>(what, [](const AnyLight&) { return LightDescription{}; });
  form.read = [what](const Value& v, Reader& reader) -> std::optional<LightDescription> {
    auto light = what.read(v, reader);
    if (!light) return std::nullopt;
    return LightDescription{.what = *std::move(light), .where = reader.sources.location(v.place)};
  };
  return form;
}

std::vector<const TableInfo*> light_tables() {
  return {&constant_table().info, &image_table().info, &sun_table().info, &rectangle_table().info,
          &point_light_table().info};
}
const AlternativesInfo& light_alternatives() { return lights().info; }

}  // namespace marrow
