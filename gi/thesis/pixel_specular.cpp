#include "gi/thesis/pixel_specular.h"

#include "gi/specular_pass.h"
#include "renderer/frame/frame.h"
#include "renderer/targets.h"

namespace irad {

void traceByPixel(SpecularPicture& picture) {
  Targets& targets = picture.targets;
  const bool jfa = fieldIsImage(picture);
  const bool kernels = static_cast<bool>(targets.visible);
  if (!kernels) {
    targets.glossy = Buffer();
    Pass pass = picture.frame.pass(kSpecularStage);
    pass.shaders({"thesis/screen.vert", jfa ? "thesis/specular_jfa.frag" : "thesis/specular.frag"});
    addRays(picture, pass);
    sampleField(picture, pass).color(targets.specular, ClearColor{}).draw(3);
    return;
  }
  listGlossy(picture, /*filtered=*/false);
  Pass pass = picture.frame.pass(kSpecularStage);
  pass.shader(jfa ? "thesis/specular_jfa.comp" : "thesis/specular.comp");
  addRays(picture, pass).write(targets.specular);
  sampleField(picture, pass).dispatchIndirect(targets.glossy);
}

}  // namespace irad
