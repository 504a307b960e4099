// Sums of the samples of each pixel, and what the ray through its middle met.
#include "renderer/transport/film/film.h"

#include <algorithm>
#include <type_traits>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

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

Film::Film(const PixelWindow& display, const PixelWindow& data)
    : display_(display),
      data_(data),
      count_(static_cast<std::size_t>(data.width()) * static_cast<std::size_t>(data.height())),
      pixels_(static_cast<PixelSums*>(::operator new(count_ * sizeof(PixelSums)))) {
  static_assert(std::is_trivially_destructible_v<PixelSums>);  // so memory is all that there is to release
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count_, 4096), [&](const auto& part) {
    std::uninitialized_value_construct(pixels_.get() + part.begin(), pixels_.get() + part.end());
  });
}

namespace {

FilmSummary summary_of_row(std::span<const PixelSums> row, const PixelWindow& data, int y) {
  FilmSummary found{.invalid = {}, .fewest_samples = row.front().samples(), .most_samples = row.front().samples()};
  for (std::size_t i = 0; i < row.size(); ++i) {
    const PixelSums& p = row[i];
    if (p.invalid() > 0 && found.invalid.count == 0) found.invalid = {0, data.x0 + static_cast<int>(i), y};
    found.invalid.count += p.invalid();
    found.uncertified_pixels += !p.centre.certified;
    found.fewest_samples = std::min(found.fewest_samples, p.samples());
    found.most_samples = std::max(found.most_samples, p.samples());
  }
  return found;
}

// The first comes first in reading order.
FilmSummary joined(const FilmSummary& a, const FilmSummary& b) {
  const InvalidSamples& first = a.invalid.count > 0 ? a.invalid : b.invalid;
  return {.invalid = {a.invalid.count + b.invalid.count, first.x, first.y},
          .uncertified_pixels = a.uncertified_pixels + b.uncertified_pixels,
          .fewest_samples = std::min(a.fewest_samples, b.fewest_samples),
          .most_samples = std::max(a.most_samples, b.most_samples)};
}

}  // namespace

FilmSummary Film::summary() const {
  if (count_ == 0) return {};
  const auto of_rows = [&](const tbb::blocked_range<int>& rows, FilmSummary so_far) {
    for (int y = rows.begin(); y < rows.end(); ++y) so_far = joined(so_far, summary_of_row(row(y), data_, y));
    return so_far;
  };
  const FilmSummary none{.invalid = {}, .fewest_samples = std::numeric_limits<std::uint32_t>::max()};
  return tbb::parallel_reduce(tbb::blocked_range<int>(data_.y0, data_.y1), none, of_rows, joined);
}

}  // namespace marrow
