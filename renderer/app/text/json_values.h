// Values as JSON that is read back without loss.
#pragma once

#include <string>

#include "field/math/vec3.h"

namespace marrow {

/// 17 digits. JSON knows no infinity: 1e999 is one to every reader that takes numbers as doubles. NaN is null.
std::string json(double);
/// An array of three.
std::string json(const Vec3d&);
/// A quoted string.
std::string json(const std::string&);

}  // namespace marrow
