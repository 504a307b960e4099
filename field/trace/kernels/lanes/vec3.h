// Vectors of three for one ray or for a packet. Part of block_kernels_<set>.cpp.

template <class F>
inline F dot3(const F (&a)[3], const F (&b)[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// A symmetric matrix, xx yy zz xy xz yz, times v.
template <class F>
inline void bend_of(const F (&h)[6], const F (&v)[3], F (&out)[3]) {
  out[0] = h[0] * v[0] + h[3] * v[1] + h[4] * v[2];
  out[1] = h[3] * v[0] + h[1] * v[1] + h[5] * v[2];
  out[2] = h[4] * v[0] + h[5] * v[1] + h[2] * v[2];
}
