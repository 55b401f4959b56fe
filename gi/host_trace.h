// What rays of hit rule `triangles` meet, found by the host (docs/method.md 5): for CPU devices, whose kernels run on
// the same cores, and for tests, as the kernel's oracle.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include <glm/glm.hpp>

#include "shaders/shared/emitters.h"
#include "shaders/shared/gi_params.h"
#include "shaders/shared/scene_gpu.h"

namespace irad {

class Context;
struct FacetList;

struct HostRay {
  glm::vec3 origin, direction;  ///< voxel units
  uint32_t own;                 ///< the triangle that it leaves, and cannot meet
  glm::vec3 at(float t) const { return origin + direction * t; }
};

/// What samples of the emitters are drawn from (gi/emitters.h).
struct EmitterSamples {
  std::span<const Emitter> table;
  float power;                          ///< EmitterTable
  std::span<const glm::vec3> exitance;  ///< of all facets, W/m^2
  uint32_t samples, seed;
};

class HostTrace {
 public:
  virtual ~HostTrace() = default;
  /// What every ray of some rows met, as traceRows has it (gi/ray_kernel.h): params.rays words per row, a facet or
  /// TRACE_*. `threads` 0: all cores; the hits do not depend on it, to the bit. `sky`: of those that escape the bin;
  /// `tintShift`: TraceRaysPush.
  virtual void rows(const MatrixParams& params, uint32_t firstRow, uint32_t rows, std::span<uint32_t> hits,
                    uint32_t threads = 0, bool sky = false, uint32_t tintShift = 0) const = 0;
  /// Per facet: the light that samples of the emitters bring, W/m^2, and (w) its variance, as the kernel without near
  /// emitters (shaders/gi/sample_emitters.comp). `threads`: as above.
  virtual void emitters(const EmitterSamples& from, std::span<glm::vec4> light, uint32_t threads = 0) const = 0;
  /// Per facet: what lights bring it straight, W/m^2, averaged over its surfels (shaders/gi/gather_surfels.comp).
  virtual void direct(std::span<const GpuLight> lights, std::span<glm::vec4> light, uint32_t threads = 0) const = 0;
  /// What rays from anywhere meet, one after the other: a facet or TRACE_*. For several threads at once.
  virtual void rays(std::span<const HostRay> rays, std::span<uint32_t> hits) const = 0;
};

/// Whether this build has one (IRAD_EMBREE).
bool canTraceOnHost();
/// For a list by classes of surfels (gi/surface.h). DeviceError where it needs more than `memory` bytes or than are
/// free, WorkError where this build has none.
std::unique_ptr<HostTrace> makeHostTrace(Context& context, const FacetList& facets,
                                         uint64_t memory = std::numeric_limits<uint64_t>::max());

}  // namespace irad
