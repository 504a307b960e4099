// Scenes that are right, but whose picture shows nothing.
#pragma once

#include "field/base/diagnostics.h"
#include "renderer/app/input/scene_input.h"
#include "renderer/scene/scene_description.h"

namespace marrow {

/// Warnings: there is no object, or nothing that shines and an integrator that needs light.
Diagnostics picture_advice(const SceneDescription&, const SceneInput&);

}  // namespace marrow
