// From sums to channels: here double becomes float.
#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include "renderer/transport/film/film.h"

namespace marrow {
namespace {

template <class T, class F>
void add(PictureRows& picture, const Film& film, std::string name, F value) {
  const auto fill = [&film, value](int y, std::span<T> row) {
    std::ranges::transform(film.row(y), row.begin(), [&](const PixelSums& p) { return static_cast<T>(value(p)); });
  };
  picture.channels.push_back({std::move(name), std::function<void(int, std::span<T>)>(fill)});
}

template <class F>
void add_rgb(PictureRows& picture, const Film& film, const std::string& prefix, F value) {
  add<float>(picture, film, prefix + "R", [value](const PixelSums& p) { return value(p).r; });
  add<float>(picture, film, prefix + "G", [value](const PixelSums& p) { return value(p).g; });
  add<float>(picture, film, prefix + "B", [value](const PixelSums& p) { return value(p).b; });
}

template <class F>
void add_vector(PictureRows& picture, const Film& film, const std::string& prefix, F value) {
  add<float>(picture, film, prefix + ".X", [value](const PixelSums& p) { return value(p)[0]; });
  add<float>(picture, film, prefix + ".Y", [value](const PixelSums& p) { return value(p)[1]; });
  add<float>(picture, film, prefix + ".Z", [value](const PixelSums& p) { return value(p)[2]; });
}

}  // namespace

PictureRows to_rows(const Film& film) {
  PictureRows picture{.display = film.display(), .data = film.data(), .channels = {}, .metadata = {}};
  add_rgb(picture, film, "", [](const PixelSums& p) { return p.mean(); });
  add<float>(picture, film, "A", [](const PixelSums& p) { return p.coverage(); });
  add<float>(picture, film, "Z", [](const PixelSums& p) { return p.centre.depth; });
  add_vector(picture, film, "N", [](const PixelSums& p) { return p.centre.normal; });
  add_vector(picture, film, "P", [](const PixelSums& p) { return p.centre.position; });
  add_rgb(picture, film, "albedo.", [](const PixelSums& p) { return p.albedo(); });
  add_rgb(picture, film, "variance.", [](const PixelSums& p) { return p.variance_of_mean(); });
  add<std::uint32_t>(picture, film, "object", [](const PixelSums& p) { return p.centre.object; });
  add<std::uint32_t>(picture, film, "samples", [](const PixelSums& p) { return p.samples(); });
  add<std::uint32_t>(picture, film, "field.evals", [](const PixelSums& p) { return p.centre.evaluations; });
  add<std::uint32_t>(picture, film, "field.certified", [](const PixelSums& p) { return p.centre.certified; });
  return picture;
}

}  // namespace marrow
