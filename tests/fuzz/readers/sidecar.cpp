// The sidecar of a scene: lights and camera bookmarks, and that they survive being written and read again.
#include "renderer/scene/sidecar.h"

#include "tests/fuzz/readers.h"

void irad::fuzz::sidecar(Bytes bytes) {
  const std::filesystem::path file = scratchFile("sidecar.irad.json", bytes);
  Sidecar first = readSidecar(file);
  writeSidecar(file, first);
  if (readSidecar(file) != first) throw Unsound("a sidecar changes when written and read");
  for (const Light& light : first.lights.value_or(std::vector<Light>{}))
    if (const std::string problem = unsound(light); !problem.empty()) throw Unsound(problem);
}
