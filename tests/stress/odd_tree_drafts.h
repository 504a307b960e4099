// General trees as nobody would model them.
#pragma once

#include <cstddef>

#include "tests/stress/body_draft.h"

namespace marrow::test {

/// The bodies of a scene of an odd kind, numbered from 0 on: names in tree_kind_names.
void draw_odd_bodies(std::size_t kind, BodyDraft&, Random&);

}  // namespace marrow::test
