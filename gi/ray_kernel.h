// Rays through the voxel grid on the device: which shader, which specialization, which resources
// (shaders/gi/trace.glsl).
#pragma once

#include <array>
#include <string>

#include "gi/field.h"
#include "renderer/frame/pass.h"
#include "shaders/shared/gi_params.h"
#include "shaders/shared/normals.h"

namespace irad {

class Frame;
struct FacetList;

/// How a stage's rays find solid voxels.
struct RayKernel {
  uint32_t method;  ///< TRACE_*
  HitRule hitRule;
  NormalEncoding encoding;
  const FacetList& facets;
  const Field& field;
  uint32_t tintShift = 0;  ///< TraceRaysPush

  /// Adds shader ("NAME.comp", or its variant "NAME_jfa.comp"), constants and the field's image to a pass.
  Pass& configure(Pass& pass, const Device& device, const std::string& name) const;
  uint64_t chebyshev(Pass& pass) const { return pass.inIfAny(field.chebyshev); }
};
RayKernel rayKernel(const FacetList& facets, const Field& field, const MatrixParams& params);
/// What rays may meet there beside opaque triangles within the grid: constants of every kernel that traces some.
Pass& mayMeet(Pass& pass, const FacetList& facets);
/// TRACE_* of rays that meet what is there whatever the settings say (shadow rays): by the field's bytes, if there are
/// any.
uint32_t exactTraversal(const Field& field);

/// Lists of rays that wait for others to go on beside them (shaders/gi/waiting_rays.glsl). Without room no ray waits,
/// which makes no difference to what rays meet.
struct WaitingLists {
  std::array<Buffer, 2> lists;        ///< one is read while the other is written
  std::array<uint32_t, 2> room = {};  ///< rays
};
/// For dispatches of so many rays: room for a quarter of them, and for the half of those that wait a second time. (Half
/// of a subgroup waits, and of the rays that have a place a third is not cast.)
WaitingLists makeWaitingLists(const Device& device, uint64_t rays);
/// Bytes of it, for each ray.
inline constexpr uint64_t kWaitingBytes = 12;
/// Whether rays of a kernel can wait, and gain by it: those of GPUs that meet nothing but the triangles of the grid.
bool raysWait(const Device& device, const RayKernel& kernel);

/// What every ray of some rows met, `rays` words per row: a facet or TRACE_*. The first kernel of the csr build; also
/// read by tests and studies. `sky`: of those that escape the bin (rule `triangles`). `waiting`: of a kernel whose
/// raysWait().
void traceRows(Frame& frame, const RayKernel& kernel, const MatrixParams& params, uint32_t firstRow, uint32_t rows,
               const Buffer& hits, bool sky = false, const char* stage = "GI BuildMatrix",
               const WaitingLists& waiting = {});

}  // namespace irad
