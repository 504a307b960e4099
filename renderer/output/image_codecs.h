// What is left to OpenImageIO. It brings some 250 shared libraries, which take 0.2 s to load: so it is a module of its
// own, loaded when the first image file is read or written.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "field/base/result.h"

namespace marrow {

/// Rows of samples as the file has them: one channel or the first three.
struct DecodedImage {
  int width = 0, height = 0, channels = 0;
  std::vector<float> samples;  ///< integers as fractions of their largest code
  bool encoded = false;        ///< the file has integers of 8 or 16 bits
};

struct PngCodes {
  int width = 0, height = 0;
  int bits = 8;                   ///< 8 or 16
  const void* samples = nullptr;  ///< red, green, blue of each pixel in as many bits
  std::vector<std::pair<std::string, std::string>> text;
};

struct ImageCodecs {
  /// `format`: OpenImageIO's name of it.
  Result<DecodedImage> (*decode)(const std::string& path, const std::string& format);
  Result<std::vector<unsigned char>> (*encode_png)(const PngCodes&);
};

/// Looked for beside the program, then where it was built.
Result<const ImageCodecs*> image_codecs();

}  // namespace marrow
