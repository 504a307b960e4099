// A picture of light from all directions.
#pragma once

#include <vector>

namespace marrow {

/// Latitude-longitude: row 0 looks up, the middle column looks to -z (to +y where z is up), columns go to the right.
struct EnvironmentImage {
  int width = 0, height = 0;
  std::vector<float> rgb;  ///< row-major, three a pixel: radiance in the working space
};

}  // namespace marrow
