// Pictures of what the pipeline holds.
#include <cmath>

#include "gi/glass.h"
#include "gi/pipeline_impl.h"
#include "gi/pixel_emitters.h"
#include "gi/specular.h"
#include "gi/views/passes.h"
#include "gi/voxelize.h"
#include "gi/writeback.h"
#include "renderer/base/error.h"

namespace irad {
namespace {

/// What surfaces give pictures, of all that those are drawn from.
constexpr uint32_t kFromSurfaces =
    FROM_TARGETS | FROM_DEPTH | FROM_DIRECT_LIGHT | FROM_INDIRECT_LIGHT | FROM_REFLECTIONS | FROM_EMITTED;

/// Whether surfaces are there that a picture may be drawn from. What comes straight from emitters is told apart where a
/// picture asks, which changes the roundings of the rest.
bool holdsSurfaces(const Targets::Surfaces& held, const Targets::Surfaces& wanted) {
  const uint32_t there = (held.from & FROM_TARGETS) != 0 ? held.from | FROM_DEPTH : held.from;
  return held.key == wanted.key && (wanted.from & ~there) == 0 && ((wanted.from ^ there) & FROM_EMITTED) == 0;
}

}  // namespace

uint64_t Pipeline::Impl::surfacesKey(const GpuCamera& from) const {
  return Digest().add(state).add(context.shaders.generation()).add(from).value();
}

void Pipeline::render(Frame& frame, const Camera& camera, View view, Targets& targets, const PictureOptions& options) {
  Impl& p = *impl_;
  p.planned.traits.pixels = uint64_t{targets.size.x} * targets.size.y;
  const GpuCamera gpu = makeGpuCamera(p.scene, camera, targets.size);
  frame.pass("Camera").update(p.camera, gpu);

  // Stages whose result the view does not show are left out.
  const Settings& obeyed = p.planned.settings();
  uint32_t from = sourcesOf(view, obeyed, p.pictureOf);
  const bool writesBack = p.now.light && p.now.light->writeback.used;
  if (writesBack) from |= FROM_TARGETS | FROM_REFLECTIONS;  // every picture does
  const auto isFrom = [&](uint32_t sources) { return (from & sources) != 0; };
  const bool pixelEmitters = p.planned.plan().pixelEmitters;
  const uint32_t indirectly = FROM_INDIRECT_LIGHT | FROM_EMITTED | FROM_REFLECTIONS;
  ViewInputs inputs = viewInputs(p.now, pixelEmitters);
  inputs.scene = &p.onDevice;
  if (p.shadows) inputs.shadows = &*p.shadows;
  if (p.picture) inputs.picture = &p.picture;
  inputs.pictureOf = p.pictureOf;
  if (p.skyOnDevice) inputs.sky = &p.skyOnDevice.record;
  inputs.range = options.range;

  const auto drawSurfaces = [&](Layer layer) {
    if (isFrom(FROM_TARGETS | FROM_DEPTH)) {
      ShadeParams shade = p.settings.camera.gpu;
      shade.exposure = std::exp2(p.settings.camera.exposureEv);
      ForwardEffects effects = p.planned.forwardEffects();
      effects.layer = layer;
      effects.kernels = rasterizesByKernels(p.context.device, p.settings);
      // The facets that pixels lie on tell, too, where the lights' shadow maps let through what a wall keeps off.
      effects.wanted = {.surfaces = isFrom(FROM_TARGETS),
                        .direct = isFrom(FROM_DIRECT_LIGHT),
                        .indirect = isFrom(FROM_DIRECT_LIGHT | indirectly),
                        .reflections = isFrom(FROM_REFLECTIONS)};
      const IndirectInputs indirect = indirectInputs(p.now, view, pixelEmitters, obeyed);
      drawScene(frame, p.onDevice, *p.shadows, indirect, p.camera, shade, targets, effects);
    }
    if (isFrom(indirectly)) lightByEmitters(frame, inputs, obeyed, targets);
    if (!isFrom(FROM_REFLECTIONS)) return;
    traceSpecular(frame, inputs, p.camera, obeyed, targets);
    // What is written back is of the surfaces that are nearest.
    if (layer == Layer::first)
      writeBack(frame, inputs, p.camera, obeyed, p.skyOnDevice ? p.sky.largest() : 0.0f, targets);
  };
  const View seen = isFrom(FROM_PICTURE) ? p.pictureOf : view;
  const ViewInfo* info = viewInfo(seen);
  inputs.composed = p.planned.on(Effect::glass) && info != nullptr && info->addsUp();
  targets.fitLayers(p.context, inputs.composed, p.planned.tinted());

  // Surfaces that are in the targets already.
  const Targets::Surfaces wanted{p.surfacesKey(gpu), from & kFromSurfaces};
  const bool there = options.shareSurfaces && !inputs.composed && holdsSurfaces(targets.surfaces, wanted);
  const bool draws = wanted.from != 0 && !there;
  if (draws) targets.surfaces = {};
  const auto drawLayer = [&](Layer layer) {
    drawSurfaces(layer);
    drawTargets(frame, seen, inputs, p.camera, obeyed, targets);
  };
  if (inputs.composed) {
    drawLayers(frame, p.settings.camera.glassLayers, p.planned.tinted(), drawLayer, targets);
  } else if (draws) {
    drawSurfaces(Layer::first);
    if (!writesBack) targets.surfaces = wanted;
  }
  drawView(frame, view, inputs, p.camera, obeyed, targets);
}

void Pipeline::setReference(glm::uvec2 size, std::span<const glm::vec4> pixels, View of) {
  IRAD_CHECK_OP(pixels.size(), ==, size_t{size.x} * size.y);
  impl_->picture = {};
  if (pixels.empty()) return;
  ImageDesc desc;
  desc.name = "reference picture";
  desc.format = VK_FORMAT_R32G32B32A32_SFLOAT;
  desc.width = size.x;
  desc.height = size.y;
  impl_->picture = Image(impl_->context.device, desc);
  impl_->pictureOf = of;
  upload(impl_->context, impl_->picture, std::as_bytes(pixels));
}
bool Pipeline::knowsIrradiance() const {
  return static_cast<bool>(impl_->expected);
}
bool Pipeline::hasReference() const {
  return static_cast<bool>(impl_->picture);
}

}  // namespace irad
