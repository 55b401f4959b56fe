// Rasterization by compute kernels (shaders/raster/raster.glsl), for devices whose graphics pipeline is narrow
// (Device::narrowGraphics). What it draws is what the graphics pipeline draws, up to the rounding of depths and of the
// corners' place in the picture.
#pragma once

#include "renderer/frame/frame.h"
#include "renderer/gpu_scene.h"

namespace irad {

/// Where the first pass of a rasterization puts triangles for the second, opaque and masked ones apart. Rasterizations
/// use it one after the other.
uint32_t rasterQueuePieces(uint32_t triangles);  ///< per kind; the first pass draws further ones, slowly
uint64_t rasterQueueBytes(uint32_t triangles);
Buffer makeRasterQueue(const Device& device, SubsystemName subsystem, uint32_t triangles);

/// One of the passes of a rasterization: the first or the second, of opaque or of masked triangles.
struct RasterStep {
  bool tiles;   ///< the second
  bool masked;  ///< what a material's alpha cuts out
};
/// All passes of `shader`, which accumulates into its target; of masked triangles only if there are any. Either kind's
/// run side by side, as far as what `declare` says they read and write lets them; it is given the address of the queue.
/// `body`: their dispatches, by rasterDispatch.
void rasterize(Frame& frame, const char* stage, std::string_view shader, const Buffer& queue, bool anyMasked,
               const std::function<void(Pass&, RasterStep, uint64_t queued)>& declare,
               const std::function<void(Commands&, RasterStep)>& body);
/// One of the `dispatches` of a pass, over this many triangles.
void rasterDispatch(Commands& commands, RasterStep step, uint32_t triangles, uint32_t dispatches);

/// The scene through a projection.
struct RasterPass {
  const char* stage;
  std::string_view shader;  ///< raster/shadow.comp or raster/visible.comp
  const Buffer& projections;
  uint64_t offset = 0;  ///< of the Projection in `projections`, bytes
  const Buffer& target;
  uint64_t targetOffset = 0;       ///< bytes
  glm::uvec2 size;                 ///< pixels
  const Buffer& queue;             ///< makeRasterQueue of all triangles
  bool cull = false;               ///< backs of single-sided materials
  bool alphaTest = true;           ///< false: masked materials are opaque
  bool blended = true;             ///< false: blended materials are left out
  uint32_t channel = 0;            ///< RasterPush::channel
  const Buffer* peeled = nullptr;  ///< a `target` of raster/visible.comp that blended materials are behind
};
void rasterScene(Frame& frame, const SceneOnDevice& scene, const RasterPass& pass);

/// "RE Depth": what a camera sees, into Targets::visible and Targets::depth.
struct Targets;
enum class Layer;
void rasterVisible(Frame& frame, const SceneOnDevice& scene, const Buffer& camera, bool alphaTest, Targets& targets,
                   Layer layer = {});

}  // namespace irad
