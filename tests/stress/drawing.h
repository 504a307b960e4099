// What scenes and rays of the stress tests draw.
#pragma once

#include "field/math/elementary.h"
#include "tests/field/random.h"

namespace marrow::test {

/// Between 10^least and 10^most.
inline double power_of_ten(Random& random, double least, double most) { return pow(10, random.between(least, most)); }

}  // namespace marrow::test
