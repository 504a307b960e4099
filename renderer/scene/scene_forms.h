// The maps of a scene outside its fields: camera, film, render, lights, materials, objects.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "renderer/scene/scene_description.h"
#include "renderer/scene/table.h"

namespace marrow {

/// A scene as its text gives it, before objects and materials are joined.
struct SceneDraft {
  int version = 1;
  std::string units;
  bool z_up = false;
  CameraDescription camera;
  FilmDescription film;
  RenderSettings render;
  std::vector<LightDescription> lights;
  std::vector<NamedMaterial> materials;
  std::vector<ObjectDescription> objects;
};

/// The whole scene. Expects that includes are merged and overrides applied.
const Table<SceneDraft>& scene_table();

/// What a file may hold that another includes.
const TableInfo& included_file_info();

std::vector<const TableInfo*> scene_tables();
std::vector<const AlternativesInfo*> scene_alternatives();

}  // namespace marrow
