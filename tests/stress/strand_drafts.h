// Bodies with blends of many skeletons.
#pragma once

#include "tests/stress/body_draft.h"

namespace marrow::test {

/// A blend that is cut, warped, beside another one or by itself.
void hundreds(BodyDraft&, Random&);
/// Crisp and sharp set operations, one on the other, on such blends.
void cuts(BodyDraft&, Random&);
/// Soft set operations, contact and sums of such a blend and of what is small beside it.
void joins(BodyDraft&, Random&);

}  // namespace marrow::test
