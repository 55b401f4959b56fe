#include "gi/glass.h"

#include "renderer/frame/frame.h"
#include "shaders/shared/passes.h"

namespace irad {
namespace {

constexpr const char* kStage = "RE Glass";

}  // namespace

void drawLayers(Frame& frame, uint32_t layers, bool tinted, const std::function<void(Layer)>& draw, Targets& targets) {
  for (uint32_t i = 0; i <= layers; ++i) {
    draw(i == 0 ? Layer::first : i < layers ? Layer::behind : Layer::opaque);
    targets.fitLayers(frame.context(), /*wanted=*/true, tinted);
    if (targets.visible) frame.pass(kStage).copy(targets.visible, targets.peeledVisible, targets.visible.bytes);
    Pass pass = frame.pass(kStage);
    pass.shader(tinted ? "forward/add_tinted_layer.comp" : "forward/add_layer.comp")
        .sample(targets.depth, pointSampler(frame.context().device))
        .read(targets.geometric)
        .write(targets.linear, targets.layers, targets.peeled);
    if (tinted) pass.read(targets.direct).write(targets.shows);
    pass.push(LayerPush{.first = i == 0, .last = i == layers}).dispatch(targets.size);
  }
}

}  // namespace irad
