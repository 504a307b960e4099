// From sums to channels: here double becomes float.
#include <algorithm>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "renderer/transport/film/film.h"

namespace marrow {
namespace {

// Channels are filled together, some pixels at a time, so that the film comes from memory once.
class Channels {
 public:
  explicit Channels(const Film& film) : pixels_(film.pixels()) {}

  template <class T, class F>
  void add(std::string name, F value) {
    names_.push_back(std::move(name));
    allocations_.push_back([this] { return std::vector<T>(pixels_.size()); });
    fills_.push_back([this, value](Samples& of_channel, std::size_t begin, std::size_t end) {
      auto& samples = std::get<std::vector<T>>(of_channel);
      for (std::size_t i = begin; i < end; ++i) samples[i] = static_cast<T>(value(pixels_[i]));
    });
  }

  std::vector<Channel> filled() const {
    std::vector<Channel> channels(names_.size());
    tbb::parallel_for(std::size_t{0}, channels.size(), [&](std::size_t c) {
      channels[c] = {names_[c], allocations_[c]()};
    });
    constexpr std::size_t in_cache = 2048;  // of some 120 bytes
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels_.size(), in_cache), [&](const auto& part) {
      for (std::size_t begin = part.begin(); begin < part.end(); begin += in_cache)
        for (std::size_t c = 0; c < channels.size(); ++c)
          fills_[c](channels[c].samples, begin, std::min(begin + in_cache, part.end()));
    });
    return channels;
  }

 private:
  using Samples = decltype(Channel::samples);
  std::span<const PixelSums> pixels_;
  std::vector<std::string> names_;
  std::vector<std::function<Samples()>> allocations_;
  std::vector<std::function<void(Samples&, std::size_t, std::size_t)>> fills_;
};

template <class F>
void add_rgb(Channels& channels, const std::string& prefix, F value) {
  channels.add<float>(prefix + "R", [value](const PixelSums& p) { return value(p).r; });
  channels.add<float>(prefix + "G", [value](const PixelSums& p) { return value(p).g; });
  channels.add<float>(prefix + "B", [value](const PixelSums& p) { return value(p).b; });
}

template <class F>
void add_vector(Channels& channels, const std::string& prefix, F value) {
  channels.add<float>(prefix + ".X", [value](const PixelSums& p) { return value(p)[0]; });
  channels.add<float>(prefix + ".Y", [value](const PixelSums& p) { return value(p)[1]; });
  channels.add<float>(prefix + ".Z", [value](const PixelSums& p) { return value(p)[2]; });
}

}  // namespace

Picture to_picture(const Film& film) {
  Channels channels(film);
  add_rgb(channels, "", [](const PixelSums& p) { return p.mean(); });
  channels.add<float>("A", [](const PixelSums& p) { return p.coverage(); });
  channels.add<float>("Z", [](const PixelSums& p) { return p.centre.depth; });
  add_vector(channels, "N", [](const PixelSums& p) { return p.centre.normal; });
  add_vector(channels, "P", [](const PixelSums& p) { return p.centre.position; });
  add_rgb(channels, "albedo.", [](const PixelSums& p) { return p.albedo(); });
  add_rgb(channels, "variance.", [](const PixelSums& p) { return p.variance_of_mean(); });
  channels.add<std::uint32_t>("object", [](const PixelSums& p) { return p.centre.object; });
  channels.add<std::uint32_t>("samples", [](const PixelSums& p) { return p.samples(); });
  channels.add<std::uint32_t>("field.evals", [](const PixelSums& p) { return p.centre.evaluations; });
  channels.add<std::uint32_t>("field.certified", [](const PixelSums& p) { return p.centre.certified; });
  return {.display = film.display(), .data = film.data(), .channels = channels.filled(), .metadata = {}};
}

}  // namespace marrow
