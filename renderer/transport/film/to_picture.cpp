// From sums to channels: here double becomes float.
#include <string>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "renderer/transport/film/film.h"

namespace marrow {
namespace {

template <class T, class F>
void add_channel(Picture& picture, const Film& film, std::string name, F value) {
  const auto& pixels = film.pixels();
  std::vector<T> samples(pixels.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels.size()), [&](const auto& part) {
    for (std::size_t i = part.begin(); i < part.end(); ++i) samples[i] = static_cast<T>(value(pixels[i]));
  });
  picture.channels.push_back({std::move(name), std::move(samples)});
}

template <class F>
void add_rgb(Picture& picture, const Film& film, const std::string& prefix, F value) {
  add_channel<float>(picture, film, prefix + "R", [&](const PixelSums& p) { return value(p).r; });
  add_channel<float>(picture, film, prefix + "G", [&](const PixelSums& p) { return value(p).g; });
  add_channel<float>(picture, film, prefix + "B", [&](const PixelSums& p) { return value(p).b; });
}

template <class F>
void add_vector(Picture& picture, const Film& film, const std::string& prefix, F value) {
  add_channel<float>(picture, film, prefix + ".X", [&](const PixelSums& p) { return value(p)[0]; });
  add_channel<float>(picture, film, prefix + ".Y", [&](const PixelSums& p) { return value(p)[1]; });
  add_channel<float>(picture, film, prefix + ".Z", [&](const PixelSums& p) { return value(p)[2]; });
}

}  // namespace

Picture to_picture(const Film& film) {
  Picture picture{.display = film.display(), .data = film.data(), .channels = {}, .metadata = {}};
  add_rgb(picture, film, "", [](const PixelSums& p) { return p.mean(); });
  add_channel<float>(picture, film, "A", [](const PixelSums& p) { return p.coverage(); });
  add_channel<float>(picture, film, "Z", [](const PixelSums& p) { return p.centre.depth; });
  add_vector(picture, film, "N", [](const PixelSums& p) { return p.centre.normal; });
  add_vector(picture, film, "P", [](const PixelSums& p) { return p.centre.position; });
  add_rgb(picture, film, "albedo.", [](const PixelSums& p) { return p.albedo(); });
  add_rgb(picture, film, "variance.", [](const PixelSums& p) { return p.variance_of_mean(); });
  add_channel<std::uint32_t>(picture, film, "object", [](const PixelSums& p) { return p.centre.object; });
  add_channel<std::uint32_t>(picture, film, "samples", [](const PixelSums& p) { return p.samples(); });
  add_channel<std::uint32_t>(picture, film, "field.evals", [](const PixelSums& p) { return p.centre.evaluations; });
  add_channel<std::uint32_t>(picture, film, "field.certified", [](const PixelSums& p) { return p.centre.certified; });
  return picture;
}

}  // namespace marrow
