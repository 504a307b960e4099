// Symmetric tensors of degree 8: sum f_i u_i^8 over strands, through which each meets all others in a time linear in
// their number, as (u . v)^8 = <u^8, v^8>. Components as in block_view.h.
#pragma once

namespace marrow {

/// How often x^i y^j z^(Degree-i-j) is among the 3^Degree products of a power of (x, y, z): Degree! / (i! j! k!),
/// exact.
template <int Degree>
struct Multinomial {
  float of[Degree + 1][Degree + 1] = {};
  consteval Multinomial() {
    for (int i = 0; i <= Degree; ++i)
      for (int j = 0; i + j <= Degree; ++j) {
        int count = 1;
        for (int k = 1; k <= i; ++k) count = count * (Degree - i + k) / k;
        for (int k = 1; k <= j; ++k) count = count * (Degree - i - j + k) / k;
        of[i][j] = static_cast<float>(count);
      }
  }
};
inline constexpr Multinomial<7> times_in_seventh;
inline constexpr Multinomial<8> times_in_eighth;

/// sum f_i g_j (u_i . u_j)^8 over all i and j of two tensors, sum f_i u_i^8 and sum g_j u_j^8, of tensor_components
/// numbers each.
double contracted(const float* a, const float* b);

}  // namespace marrow
