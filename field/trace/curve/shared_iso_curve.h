// Curves that several blends have in common.
#pragma once

#include <memory>

#include "field/trace/curve/iso_curve.h"

namespace marrow {

/// As the constructors of IsoCurve, for one angle where `least` is `most`. What is made is kept as long as anybody has
/// it: a table takes some milliseconds, those of a range a hundred times that, and scenes have thousands of blends
/// alike. Safe to use from many threads.
std::shared_ptr<const IsoCurve> shared_iso_curve(const Correction&, double least, double most, UpToGradient);

}  // namespace marrow
