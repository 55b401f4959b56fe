// Hits of rays in mapped memory, for devices that are CPUs: of the driver's kernel, or of the host itself where it can.
#pragma once

#include <cstdint>

namespace irad {

class Buffer;
class Context;
class HostTrace;
struct FacetList;
struct MatrixParams;
struct RayKernel;

/// The host's own rays, for devices that are CPUs, where the hit rule and this build allow them; else null. They are
/// kept with the list, since they go by its geometry alone: the first that asks makes them, and its `stage` has that
/// time.
const HostTrace* hostTraceIfAny(Context& context, const FacetList& facets, const MatrixParams& params,
                                const char* stage);

/// What the rays of some rows meet, as traceRows has it (gi/ray_kernel.h), in `hits`, which is mapped: by `host`, or by
/// the kernel where that is null. Blocking; the host may read and the device may be given what is there.
void traceMapped(Context& context, const RayKernel& kernel, const HostTrace* host, const MatrixParams& params,
                 uint32_t firstRow, uint32_t rows, const Buffer& hits, bool sky, const char* stage);

}  // namespace irad
