// Builds without Embree.
#include "gi/check/path_tracer.h"
#include "renderer/base/error.h"
#include "renderer/scene/scene.h"

namespace irad {

bool hasPathTracer() {
  return false;
}

std::unique_ptr<PathTracer> makePathTracer(Scene, Sky) {
  throw WorkError("this build has no path tracer (IRAD_EMBREE)");
}

}  // namespace irad
