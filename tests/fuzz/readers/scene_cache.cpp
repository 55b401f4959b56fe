// .irscene, the cache of decoded scenes, whole and with a node of it alone.
#include "renderer/scene/nodes.h"
#include "renderer/scene/scene.h"
#include "tests/fuzz/readers.h"

void irad::fuzz::scene_cache(Bytes bytes) {
  Scene scene = loadScene(scratchFile("scene.irscene", bytes));
  const auto check = [&] {
    if (const std::string problem = unsound(scene); !problem.empty()) throw Unsound(problem);
  };
  check();
  if (scene.nodes.empty()) return;
  hideNodes(scene, {.paths = {}, .isolated = nodePath(scene.nodes, static_cast<uint32_t>(scene.nodes.size() / 2))});
  check();
}
