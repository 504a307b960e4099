// Sums of the samples of each pixel, and what the ray through its middle met.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include "materials/rgb.h"
#include "renderer/output/picture.h"

namespace marrow {

/// What the ray through the middle of a pixel met: free of noise.
struct CentreHit {
  float depth = std::numeric_limits<float>::infinity();  ///< along the camera's axis; +inf: nothing
  std::array<float, 3> normal{};
  std::array<float, 3> position{};
  std::uint32_t object = 0;  ///< ObjectId + 1; 0: nothing
  std::uint32_t evaluations = 0;
  bool certified = true;
};

/// One camera sample.
struct FilmSample {
  Rgb radiance;
  Rgb albedo;            ///< of the first surface; black where there is none
  bool covered = false;  ///< a surface or a visible light was met
};

/// Sums in the order of the samples, in double; of albedo in float, off by 2^-24 of the
/// sum a sample at most. One thread adds all samples of a pixel.
class PixelSums {
 public:
  /// A radiance that is not finite or is negative is not added but counted; returns whether it was added.
  bool add(const FilmSample&);

  std::uint32_t samples() const { return samples_; }
  std::uint32_t invalid() const { return invalid_; }
  Rgb mean() const;
  Rgb albedo() const;
  double coverage() const;
  /// Estimated variance of the mean: the square of its standard error. 0 below two samples.
  Rgb variance_of_mean() const;

  CentreHit centre;

 private:
  Rgb sum_, sum_of_squares_;
  std::array<float, 3> albedo_sum_{};
  std::uint32_t covered_ = 0;
  std::uint32_t samples_ = 0;
  std::uint32_t invalid_ = 0;
};

enum class StopReason { Samples, Time, Interrupted };

/// Samples that had to be dropped.
struct InvalidSamples {
  std::uint64_t count = 0;
  int x = 0, y = 0;  ///< the first pixel in reading order that had one
};

/// What is to be said of a film as a whole.
struct FilmSummary {
  InvalidSamples invalid;
  std::uint64_t uncertified_pixels = 0;  ///< their middle ray was not certified
  std::uint32_t fewest_samples = 0, most_samples = 0;
};

class Film {
 public:
  /// Takes its memory on all threads.
  Film(const PixelWindow& display, const PixelWindow& data);

  const PixelWindow& display() const { return display_; }
  const PixelWindow& data() const { return data_; }
  /// Absolute coordinates inside data().
  PixelSums& at(int x, int y) { return pixels_[index(x, y)]; }
  const PixelSums& at(int x, int y) const { return pixels_[index(x, y)]; }
  /// Row-major over data().
  std::span<const PixelSums> pixels() const { return {pixels_.get(), count_}; }
  std::span<const PixelSums> row(int y) const {
    return pixels().subspan(index(data_.x0, y), static_cast<std::size_t>(data_.width()));
  }

  FilmSummary summary() const;

  StopReason stopped_by = StopReason::Samples;
  double elapsed_s = 0;

 private:
  struct Release {
    void operator()(PixelSums* pixels) const { ::operator delete(pixels); }
  };

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - data_.y0) * static_cast<std::size_t>(data_.width()) +
           static_cast<std::size_t>(x - data_.x0);
  }

  PixelWindow display_, data_;
  std::size_t count_;
  std::unique_ptr<PixelSums[], Release> pixels_;
};

/// Channels R G B A, Z, N.X N.Y N.Z, P.X P.Y P.Z, albedo.R/G/B, variance.R/G/B (of the mean) as float; object
/// (id + 1, 0: none), samples, field.evals and field.certified (1: it is proved that the ray through the pixel's middle
/// skipped no surface before its hit, or anywhere if it met none; 0: RayRecord says why not) as unsigned. A is the
/// share of samples that met a surface or a visible light; R G B also hold what is seen of the environment. No
/// metadata. The rows are made from the film, which must outlive them, when they are asked for.
PictureRows to_rows(const Film&);

}  // namespace marrow
