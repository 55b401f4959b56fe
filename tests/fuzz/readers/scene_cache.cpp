// .irscene, the cache of decoded scenes.
#include "renderer/scene/scene.h"
#include "tests/fuzz/readers.h"

void irad::fuzz::scene_cache(Bytes bytes) {
  const std::string problem = unsound(loadScene(scratchFile("scene.irscene", bytes)));
  if (!problem.empty()) throw Unsound(problem);
}
