// A scene as its author wrote it: what read_scene() makes and compile_scene() takes. Plain data.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "field/base/diagnostics.h"
#include "field/base/id.h"
#include "field/description/field_node.h"
#include "field/math/vec3.h"
#include "materials/material_description.h"
#include "materials/rgb.h"

namespace marrow {

/// Right-handed camera; looks from `from` to `to`.
struct CameraDescription {
  enum class Type { Perspective, Orthographic };
  Type type = Type::Perspective;
  Vec3d from{0, 0, 5}, to{0, 0, 0}, up{0, 1, 0};
  double fov_deg = 35;  ///< vertical, perspective only
  double height = 2;    ///< of the picture in scene units, orthographic only
};

struct FilmDescription {
  int width = 1280, height = 720;
};

struct RenderSettings {
  enum class Integrator { Path, Direct, Normals, Depth };
  Integrator integrator = Integrator::Path;
  int samples_per_pixel = 64;
  std::uint64_t seed = 1;
  int max_depth = 16;  ///< surfaces along a path that may scatter; 1 is direct light only
};

struct ConstantLight {
  Rgb radiance{1};
};
/// Latitude-longitude picture, up is +y (or the scene's up axis); `rotate_deg` turns it about up.
struct ImageLight {
  std::filesystem::path file;  ///< resolved against the scene's folder
  double rotate_deg = 0;
  Rgb scale{1};
};
/// `direction` points toward the sun; `irradiance` on a surface that faces it; `angle_deg` is the disc's diameter.
struct SunLight {
  Vec3d direction{0, 1, 0};
  Rgb irradiance{3};
  double angle_deg = 0.53;
};
/// Emits on the side of `normal`; seen by rays from that side, casts no shadow itself.
struct RectangleLight {
  Vec3d center, normal{0, -1, 0};
  double width = 1, height = 1;
  Rgb radiance{1};
};
/// Isotropic; `intensity` per steradian.
struct PointLight {
  Vec3d position;
  Rgb intensity{1};
};
struct LightDescription {
  std::variant<ConstantLight, ImageLight, SunLight, RectangleLight, PointLight> what;
  SourceLocation where;
};

struct NamedMaterial {
  std::string name;
  MaterialDescription what;
  SourceLocation where;
};

/// Infinite.
struct PlaneShape {
  Vec3d point{0, 0, 0}, normal{0, 1, 0};
};
/// Triangles from OBJ or PLY, indices into `positions`.
struct MeshShape {
  std::vector<Vec3d> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};
struct ObjectDescription {
  std::string name;
  MaterialId material;
  std::variant<FieldDescription, PlaneShape, MeshShape> shape;
  SourceLocation where;
};

struct SceneDescription {
  std::string units;  ///< for legends only; may be empty
  bool z_up = false;
  CameraDescription camera;
  FilmDescription film;
  RenderSettings render;
  std::vector<LightDescription> lights;
  std::vector<NamedMaterial> materials;  ///< MaterialId indexes this
  std::vector<ObjectDescription> objects;
  std::string hash;  ///< of all bytes read (scene, includes, data) and overrides, 32 hex digits
};

}  // namespace marrow
