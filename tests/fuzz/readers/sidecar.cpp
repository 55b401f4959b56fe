// The sidecar of a scene: lights, materials and camera bookmarks, and that they survive being written and read again.
#include "renderer/scene/sidecar.h"

#include "renderer/scene/material_edits.h"

#include "tests/fuzz/readers.h"

void irad::fuzz::sidecar(Bytes bytes) {
  const std::filesystem::path file = scratchFile("sidecar.irad.json", bytes);
  Sidecar first = readSidecar(file);
  writeSidecar(file, first);
  if (readSidecar(file) != first) throw Unsound("a sidecar changes when written and read");
  for (const Light& light : first.lights.value_or(std::vector<Light>{}))
    if (const std::string problem = unsound(light); !problem.empty()) throw Unsound(problem);
  for (const MaterialEdit& edit : first.materials)
    if (const std::string problem = unsound(edited(Material{.alpha = AlphaMode::Mask}, edit), 0); !problem.empty())
      throw Unsound(problem);
}
