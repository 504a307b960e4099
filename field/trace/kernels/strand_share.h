// The share of the range of angles as the strands of a level tell it. Part of block_kernels_<set>.cpp.

void strand_share(const FieldLevel& level, int degree, const float p[3], StrandShare& out) {
  constexpr float axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  StrandsAt<3> at(level, degree, p, axes);
  at.near.add_angles(*level.strands, at.far);
  const Along<3> above = at.near.numerator + at.near.numerator + at.sum_of_far(1),
                 below = at.near.denominator + at.near.denominator + at.sum_of_far(2);
  out = {.share = 1, .gradient = {}};
  if (!(below.value > 1e-36F)) return;
  const float inverse = 1 / below.value;
  out.share = min_of(1, max_of(0, above.value * inverse));
  for (int i = 0; i < 3; ++i) out.gradient[i] = (above.slope[i] - out.share * below.slope[i]) * inverse;
}
