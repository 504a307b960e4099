// `-D path.to.value=text`: values of the command line put into the document before it is read.
#pragma once

#include <string>
#include <vector>

#include "renderer/scene/document.h"
#include "renderer/scene/reader.h"

namespace marrow {

/// Applies them in order. Reports paths that lead nowhere; what stands at their end is checked with the scene.
void apply_overrides(Value& scene, const std::vector<std::string>& overrides, Reader&, std::size_t& values_left);

}  // namespace marrow
