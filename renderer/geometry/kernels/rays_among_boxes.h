// Rays among boxes, as many at a time as a register has doubles. Part of box_kernels_<set>.cpp.
//
// Operation by operation what ray_in_boxes.h and part_hierarchy.cpp do for one ray.

using Keys = DoubleMask;
using Ints = int __attribute__((vector_size(4 * double_lanes)));

inline constexpr float smallest_float = __FLT_MIN__;

// Memory of Embree, aligned as it likes.
template <class V, class T>
inline V load_anywhere(const T* p) {
  V v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}
template <class V, class T>
inline void store_anywhere(V v, T* p) {
  __builtin_memcpy(p, &v, sizeof v);
}

inline Doubles size_of(Doubles v) { return reinterpret_cast<Doubles>(reinterpret_cast<Keys>(v) & __LONG_LONG_MAX__); }

struct StretchesInBox {
  Doubles enter, exit;
  void clip(double lower, double upper, Doubles origin, Doubles inverse) {
    const Doubles a = (lower - origin) * inverse, b = (upper - origin) * inverse;
    enter = first_max(enter, first_min(a, b));
    exit = first_min(exit, first_max(a, b));
  }
};

inline Floats embree_t(Doubles t_start, Doubles t) {
  return narrowed((t - t_start) * (1 + float_share)) + smallest_float;
}

// The margin of boxes as a way along the ray.
inline Doubles margin_along(const Doubles (&direction)[3], double margin) {
  Doubles least = Doubles{} + 1;
  for (const Doubles d : direction) {
    const Doubles size = size_of(d);
    least = d != 0 ? first_min(least, size) : least;
  }
  return margin / least;
}

inline unsigned start_some(const BoxKernels::Bounds& bounds, RaysAmongBoxes& rays, const FloatRays& out, int first) {
  StretchesInBox inside{load(rays.t_min + first), load(rays.last + first)};
  Doubles origin[3], direction[3];
  for (int k = 0; k < 3; ++k) {
    origin[k] = load(rays.origin[k] + first);
    direction[k] = load(rays.direction[k] + first);
    const Doubles inverse = 1 / direction[k];
    store(inverse, rays.inverse[k] + first);
    inside.clip(bounds.lower[k], bounds.upper[k], origin[k], inverse);
  }
  const DoubleMask in = inside.enter <= inside.exit;
  const Doubles enter = in ? inside.enter : Doubles{}, late = margin_along(direction, bounds.margin);
  for (int k = 0; k < 3; ++k) {
    const Doubles seen = size_of(direction[k]) < smallest_component ? Doubles{} : direction[k];
    store(narrowed(in ? origin[k] + direction[k] * enter - bounds.middle[k] : Doubles{}), out.origin[k] + first);
    store(narrowed(seen), out.direction[k] + first);
  }
  const Doubles gone = (load(rays.taken_enter + first) - enter) * (1 - float_share) - late;
  store(narrowed(gone > 0 ? gone : Doubles{}), out.t_near + first);
  const Floats t_far = embree_t(enter, in ? inside.exit : Doubles{} - __builtin_inf());
  store(t_far, out.t_far + first);
  store(enter, rays.t_start + first);
  store(late, rays.late + first);
  for (int i = 0; i < RaysAmongBoxes::most; ++i) {
    store(Doubles{} + __builtin_inf(), rays.enter[i] + first);
    store(Keys{} + RaysAmongBoxes::nobody, rays.key[i] + first);
  }
  return bits_of_mask(in);
}

inline bool go_with_first(const RaysAmongBoxes& rays) {
  constexpr double least_cosine = 0.99;
  unsigned apart = 0;
  for (int first = 0; first < RaysAmongBoxes::count; first += double_lanes) {
    const auto product = [&](int k) { return load(rays.direction[k] + first) * rays.direction[k][0]; };
    apart |= bits_of_mask(~(product(0) + product(1) + product(2) >= least_cosine));
  }
  return apart == 0;
}

BoxKernels::Started start(const BoxKernels::Bounds& bounds, RaysAmongBoxes& rays, const FloatRays& out) {
  BoxKernels::Started started{0, go_with_first(rays)};
  for (int first = 0; first < RaysAmongBoxes::count; first += double_lanes)
    started.in_bounds |= start_some(bounds, rays, out, first) << first;
  return started;
}

// As PartEntry, and compared like it.
struct Entries {
  Doubles enter;
  Keys key;
};
inline DoubleMask before(const Entries& a, const Entries& b) {
  return (a.enter < b.enter) | ((a.enter == b.enter) & (a.key < b.key));
}
inline Entries entries_at(const double* enter, const long long* key) { return {load(enter), load_as<Keys>(key)}; }

// Those behind their places make room. All places are tried at once: one after the other would wait for each other.
inline void insert(const Entries& some, RaysAmongBoxes& rays, int first) {
  Entries there[RaysAmongBoxes::most];
  DoubleMask here[RaysAmongBoxes::most];
  for (int i = 0; i < RaysAmongBoxes::most; ++i) {
    there[i] = entries_at(rays.enter[i] + first, rays.key[i] + first);
    here[i] = before(some, there[i]);
  }
  for (int i = 0; i < RaysAmongBoxes::most; ++i) {
    const Doubles enter = i > 0 ? (here[i - 1] ? there[i - 1].enter : some.enter) : some.enter;
    const Keys key = i > 0 ? (here[i - 1] ? there[i - 1].key : some.key) : some.key;
    store(here[i] ? enter : there[i].enter, rays.enter[i] + first);
    store(here[i] ? key : there[i].key, rays.key[i] + first);
  }
}

void note(const double (&lower)[3], const double (&upper)[3], long long key, const int* asked, RaysAmongBoxes& rays,
          float* t_far) {
  constexpr int last = RaysAmongBoxes::most - 1;
  for (int first = 0; first < RaysAmongBoxes::count; first += double_lanes) {
    StretchesInBox inside{load(rays.t_min + first), load(rays.last + first)};
    for (int k = 0; k < 3; ++k)
      inside.clip(lower[k], upper[k], load(rays.origin[k] + first), load(rays.inverse[k] + first));
    const Entries some{inside.enter, Keys{} + key};
    const DoubleMask in = (inside.enter <= inside.exit) &
                          (__builtin_convertvector(load_anywhere<Ints>(asked + first), Keys) != 0) &
                          before(entries_at(rays.taken_enter + first, rays.taken_key + first), some) &
                          before(some, entries_at(rays.enter[last] + first, rays.key[last] + first));
    if (bits_of_mask(in) == 0) continue;
    insert({in ? some.enter : Doubles{} + __builtin_inf(), in ? some.key : Keys{} + RaysAmongBoxes::nobody}, rays,
           first);
    const Floats end = embree_t(load(rays.t_start + first), load(rays.enter[last] + first) + load(rays.late + first));
    store_anywhere(first_min(load_anywhere<Floats>(t_far + first), end), t_far + first);
  }
}
