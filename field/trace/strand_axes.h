// 45 axes whose eighth powers span all symmetric tensors of degree 8.
//
// A sum T = sum f_i u_i^8 then is sum w_k v_k^8 with fixed axes v_k, so that sum f_i (u_i . u)^8 = sum w_k (v_k . u)^8
// for every u: no powers of components are needed. The axes are a spiral over half of the sphere, for which
// sum |w_k| <= 16 of one u of length 1 (found numerically), so that floats lose one digit.
#pragma once

#include "field/trace/block_kernels.h"

namespace marrow {

/// x[48] y[48] z[48], the last three 0; 64-byte aligned.
const float* strand_axes();

/// The weights of a tensor of tensor_components numbers: tensor_floats of them, 0 behind the last axis.
void weights_of_tensor(const float* tensor, float* weights);

/// sum f_i f_j (u_i . u_j)^8 over all i and j of a tensor sum f_i u_i^8 of tensor_components numbers.
double contracted_with_itself(const float* tensor);

}  // namespace marrow
