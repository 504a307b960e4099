#include "field/trace/shares/strand_quadratics.h"

#include <algorithm>
#include <array>

#include "field/trace/kernels/strand_places.h"

namespace marrow {
namespace {

// Coefficients from values at strand_place, by least squares. The places are symmetric: slopes and mixed terms are
// means of differences; of the squares x^2 - (x^2 + y^2 + z^2) / 3 comes from the faces, and the constant and the trace
// from three means.
struct QuadraticFit {
  std::array<std::array<double, strand_places>, quadratic_monomials> row{};

  QuadraticFit() {
    const double face = place_in_cube(1).x, corner = place_in_cube(7).x;
    const double a = face * face, b = corner * corner;
    double linear[3] = {}, mixed = 0;
    for (std::size_t k = 0; k < strand_places; ++k) {
      const Vec3d x = place_in_cube(k);
      for (std::size_t i = 0; i < 3; ++i) linear[i] += x[i] * x[i];
      const double xy = x[0] * x[1];
      mixed += xy * xy;
    }
    // c0 + t q for t = 0, a/3, b with weights 1, 6, 8
    const double w[3] = {1, 6, 8}, t[3] = {0, a / 3, b};
    double total = 0, mean = 0, square = 0;
    for (int k = 0; k < 3; ++k) total += w[k], mean += w[k] * t[k];
    mean /= total;
    for (int k = 0; k < 3; ++k) square += w[k] * (t[k] - mean) * (t[k] - mean);
    for (std::size_t k = 0; k < strand_places; ++k) {
      const Vec3d x = place_in_cube(k);
      const int kind = k == 0 ? 0 : k < 7 ? 1 : 2;
      const double trace = (t[kind] - mean) / square;
      row[0][k] = 1 / total - mean * trace;
      for (std::size_t i = 0; i < 3; ++i) {
        row[1 + i][k] = x[i] / linear[i];
        row[4 + i][k] = trace / 3;
        if (kind == 1) row[4 + i][k] += ((x[i] != 0 ? 0.5 : 0) - 1.0 / 6) / a;
      }
      row[7][k] = x[0] * x[1] / mixed;
      row[8][k] = x[0] * x[2] / mixed;
      row[9][k] = x[1] * x[2] / mixed;
    }
  }
};

const QuadraticFit fit;

}  // namespace

void fit_quadratics(const float* values, std::size_t width, float* coefficients) {
  for (std::size_t m = 0; m < quadratic_monomials; ++m) {
    float* to = coefficients + m * width;
    std::fill_n(to, width, 0.0F);
    for (std::size_t k = 0; k < strand_places; ++k) {
      const auto c = static_cast<float>(fit.row[m][k]);
      for (std::size_t i = 0; i < width; ++i) to[i] += c * values[k * width + i];
    }
  }
}

void add_quadratics(const float* coefficients, std::size_t width, const Vec3d& x, float* sums) {
  const double monomials[quadratic_monomials] = {1,         x.x,       x.y,       x.z,       x.x * x.x,
                                                 x.y * x.y, x.z * x.z, x.x * x.y, x.x * x.z, x.y * x.z};
  for (std::size_t m = 0; m < quadratic_monomials; ++m) {
    const auto c = static_cast<float>(monomials[m]);
    for (std::size_t i = 0; i < width; ++i) sums[i] += c * coefficients[m * width + i];
  }
}

}  // namespace marrow
