// Sums of the samples of each pixel, and what the ray through its middle met.
#include "renderer/transport/film/film.h"

#include <algorithm>

namespace marrow {
namespace {

bool valid(Rgb c) { return is_finite(c) && c.r >= 0 && c.g >= 0 && c.b >= 0; }

}  // namespace

bool PixelSums::add(const FilmSample& sample) {
  if (!valid(sample.radiance)) {
    ++invalid_;
    return false;
  }
  ++samples_;
  covered_ += sample.covered;
  sum_ += sample.radiance;
  sum_of_squares_ += sample.radiance * sample.radiance;
  for (std::size_t i = 0; i < 3; ++i) albedo_sum_[i] += static_cast<float>(sample.albedo[i]);
  return true;
}

Rgb PixelSums::mean() const { return samples_ == 0 ? Rgb{} : sum_ / samples_; }

Rgb PixelSums::albedo() const {
  if (samples_ == 0) return {};
  return Rgb(albedo_sum_[0], albedo_sum_[1], albedo_sum_[2]) / samples_;
}

double PixelSums::coverage() const { return samples_ == 0 ? 0 : double(covered_) / samples_; }

Rgb PixelSums::variance_of_mean() const {
  if (samples_ < 2) return {};
  const double n = samples_;
  const Rgb spread = sum_of_squares_ - sum_ * sum_ / n;
  const double scale = 1 / (n * (n - 1));
  return {std::max(spread.r, 0.0) * scale, std::max(spread.g, 0.0) * scale, std::max(spread.b, 0.0) * scale};
}

InvalidSamples Film::invalid_samples() const {
  InvalidSamples found;
  for (int y = data_.y0; y < data_.y1; ++y)
    for (int x = data_.x0; x < data_.x1; ++x) {
      const std::uint32_t here = at(x, y).invalid();
      if (here > 0 && found.count == 0) found.x = x, found.y = y;
      found.count += here;
    }
  return found;
}

std::uint64_t Film::uncertified_pixels() const {
  return static_cast<std::uint64_t>(
      std::ranges::count_if(pixels_, [](const PixelSums& p) { return !p.centre.certified; }));
}

std::uint64_t Film::centre_evaluations() const {
  std::uint64_t sum = 0;
  for (const PixelSums& p : pixels_) sum += p.centre.evaluations;
  return sum;
}

}  // namespace marrow
