// Rays through the voxel grid on the device: which shader, which specialization, which resources
// (shaders/gi/trace.glsl).
#pragma once

#include "gi/stages.h"
#include "shaders/shared/trace.h"

namespace irad {

/// How a stage's rays find solid voxels.
struct RayKernel {
  uint32_t method;  ///< TRACE_*
  uint32_t hitRule;
  uint32_t encoding;
  const FacetList& facets;
  const Field& field;

  /// Adds shader ("gi/NAME.comp" or "gi/NAME_jfa.comp"), constants and resources to a pass.
  Pass& configure(Pass& pass, const Device& device, const std::string& name) const;
  uint64_t chebyshev() const { return field.chebyshev.address; }
};
RayKernel rayKernel(const FacetList& facets, const Field& field, const MatrixParams& params);

/// What every ray of some rows met, `rays` words per row: a facet or TRACE_*. The first kernel of the csr build; also
/// read by tests and studies.
void traceRows(Frame& frame, const RayKernel& kernel, const MatrixParams& params, uint32_t firstRow, uint32_t rows,
               const Buffer& hits);

}  // namespace irad
