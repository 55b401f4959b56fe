// Builds without Embree.
#include "gi/host_trace.h"
#include "renderer/base/error.h"

namespace irad {

bool canTraceOnHost() {
  return false;
}

std::unique_ptr<HostTrace> makeHostTrace(Context&, const FacetList&, uint64_t) {
  throw WorkError("this build cannot trace on the host (IRAD_EMBREE)");
}

}  // namespace irad
