// A Jacobi sweep by the host on all cores, for CPU devices: their driver gathers B lane by lane, which takes ten times
// as long. The arithmetic is that of a kernel with an invocation per row (shaders/gi/solve_row.comp), in its order.
#pragma once

#include "shaders/gi/solve_row.h"

namespace irad {

/// Rows of format csr. Addresses are of host memory (gi/host_pass.h). `tinted`: FormFactors. What is watched goes into
/// push.residual.
void sweepOnHost(const SolvePush& push, const MatrixArrays& matrix, const FacetArrays& facets, const SolveWork& work,
                 bool tinted);

}  // namespace irad
