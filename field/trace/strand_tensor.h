// Symmetric tensors of degree 8: sum f_i u_i^8 over strands, through which each meets all others in a time linear in
// their number (field-maths 7). Components as in block_view.h.
#pragma once

namespace marrow {

/// sum f_i f_j (u_i . u_j)^8 over all i and j of a tensor sum f_i u_i^8 of tensor_components numbers.
double contracted_with_itself(const float* tensor);

}  // namespace marrow
