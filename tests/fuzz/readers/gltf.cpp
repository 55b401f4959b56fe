// .gltf and .glb, whole: container, JSON, buffers, accessors, Draco, meshopt, images, geometry. (The first bytes decide
// which of the two it is, so one file name serves both.)
#include "renderer/scene/scene.h"
#include "tests/fuzz/readers.h"

void irad::fuzz::gltf(Bytes bytes) {
  const std::string problem = unsound(loadScene(scratchFile("scene.gltf", bytes)));
  if (!problem.empty()) throw Unsound(problem);
}
