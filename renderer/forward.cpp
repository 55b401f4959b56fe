#include "renderer/forward.h"

#include <algorithm>
#include <cmath>

#include "renderer/depth_pass.h"
#include "renderer/error.h"
#include "shaders/shared/passes.h"
#include "shaders/shared/view.h"

namespace irad {
namespace {

Image target(const Device& device, const char* name, VkFormat format, glm::uvec2 size, VkImageUsageFlags attachment) {
  ImageDesc desc;
  desc.name = name;
  desc.subsystem = Subsystem::Targets;
  desc.format = format;
  desc.width = size.x;
  desc.height = size.y;
  desc.usage =
      VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | attachment;
  return Image(device, desc);
}

bool hasFlag(const SceneOnDevice& scene, const Draw& draw, uint32_t flag) {
  return (scene.materialValues.at(draw.material).flags & flag) != 0;
}

VkCullModeFlags culling(const SceneOnDevice& scene, const Draw& draw) {
  return hasFlag(scene, draw, MATERIAL_DOUBLE_SIDED) ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT;
}

constexpr uint32_t kAnyTexture = MATERIAL_BASE_COLOR_TEXTURE | MATERIAL_METALLIC_ROUGHNESS_TEXTURE |
                                 MATERIAL_NORMAL_TEXTURE | MATERIAL_OCCLUSION_TEXTURE | MATERIAL_EMISSIVE_TEXTURE;

/// IRAD_SHADOW_KINDS of shaders/forward/shadow.glsl.
uint32_t shadowKinds(const SceneOnDevice& scene) {
  uint32_t kinds = 0;
  for (const GpuLight& light : scene.lightValues) kinds |= lightUsesCube(light.type, light.outerCos) ? 2 : 1;
  return kinds;
}

/// Largest and smallest distance of the bounds' corners along the view direction.
glm::dvec2 depthOfBounds(const Scene& scene, const glm::dvec3& eye, const glm::dvec3& forward) {
  glm::dvec2 range(1e300, -1e300);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 c((corner & 1) != 0 ? scene.boundsMax.x : scene.boundsMin.x,
                       (corner & 2) != 0 ? scene.boundsMax.y : scene.boundsMin.y,
                       (corner & 4) != 0 ? scene.boundsMax.z : scene.boundsMin.z);
    const double d = glm::dot(c - eye, forward);
    range = {std::min(range.x, d), std::max(range.y, d)};
  }
  return range;
}

}  // namespace

Targets::Targets(Context& context, glm::uvec2 extent) : size(extent) {
  IRAD_CHECK(size.x > 0 && size.y > 0, "{} x {}", size.x, size.y);
  const VkImageUsageFlags color = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT;
  const VkFormat half = VK_FORMAT_R16G16B16A16_SFLOAT, full = VK_FORMAT_R32G32B32A32_SFLOAT;
  const Device& device = context.device;
  depth = target(device, "depth", VK_FORMAT_D32_SFLOAT, size, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
  normal = target(device, "normal, roughness", half, size, color);
  geometric = target(device, "geometric normal, metallic", half, size, color);
  albedo = target(device, "albedo, occlusion", half, size, color);
  f0 = target(device, "specular reflectance", half, size, color);
  direct = target(device, "direct irradiance", full, size, color);
  highlight = target(device, "highlights and emission", full, size, color);
  indirect = target(device, "indirect irradiance", full, size, color);
  emitted = target(device, "irradiance of emitters", full, size, color);
  specular = target(device, "specular radiance", full, size, color);
  glossy = Buffer(device, "glossy pixels", Subsystem::Targets, 4ull * (GLOSSY_FIRST + size.x * size.y));
  viewRange = Buffer(device, "range of the view", Subsystem::Targets, sizeof(ViewRange));
  viewBins = Buffer(device, "histogram of the view", Subsystem::Targets, 4ull * RANGE_BINS);
  linear = target(device, "linear picture", full, size, color);
  display = target(device, "display picture", VK_FORMAT_R8G8B8A8_UNORM, size, color);
}

GpuCamera makeGpuCamera(const Scene& scene, const Camera& camera, glm::uvec2 size) {
  // Camera axes in local space; the position relative to the scene's origin in double precision.
  const glm::dvec3 eye = camera.position - scene.origin;
  const glm::dmat3 axes = glm::mat3_cast(glm::dquat(glm::normalize(camera.orientation)));
  const glm::dvec3 right = axes[0], up = axes[1], forward = -axes[2];

  // Planes: the file's, the far one from the bounds where it gives none.
  const glm::dvec2 range = depthOfBounds(scene, eye, forward);
  double nearPlane = camera.znear, farPlane = camera.zfar;
  if (!(farPlane > nearPlane)) {
    const double extent = glm::length(glm::dvec3(scene.boundsMax) - glm::dvec3(scene.boundsMin));
    farPlane = std::max(range.y + extent / 256.0, extent / 256.0);
    if (!(farPlane > 0.0)) farPlane = 1.0;
    if (camera.orthographic) nearPlane = std::min(nearPlane, farPlane - extent / 256.0);
    if (!(farPlane > nearPlane)) farPlane = nearPlane > 0.0 ? 2.0 * nearPlane : nearPlane + 1.0;
  }
  if (!camera.orthographic && !(nearPlane > 0.0)) nearPlane = farPlane / 4096.0;

  // Clip = projection x view, Vulkan depth 0..1, y up (the frame flips the viewport).
  const double aspect = static_cast<double>(size.x) / size.y;
  const double halfHeight = camera.orthographic ? camera.ymag : std::tan(0.5 * camera.yfov);
  const double sx = 1.0 / (halfHeight * aspect), sy = 1.0 / halfHeight;
  const auto row = [&](const glm::dvec3& axis, double scale) {
    return glm::dvec4(axis * scale, -glm::dot(axis, eye) * scale);
  };
  glm::dmat4 rows(0.0);
  rows[0] = row(right, sx);
  rows[1] = row(up, sy);
  if (camera.orthographic) {
    rows[2] = row(forward, 1.0 / (farPlane - nearPlane));
    rows[2].w -= nearPlane / (farPlane - nearPlane);
    rows[3] = {0, 0, 0, 1};
  } else {
    const double scale = farPlane / (farPlane - nearPlane);
    rows[2] = row(forward, scale);
    rows[2].w -= nearPlane * scale;
    rows[3] = row(forward, 1.0);
  }
  const glm::dmat4 clip = glm::transpose(rows);

  // The inverse, written down rather than computed: local = eye + axes x view.
  glm::dmat4 viewFromClip(0.0);  // columns: contributions of clip x, y, z, w to (right, up, forward, 1)
  viewFromClip[0][0] = 1.0 / sx;
  viewFromClip[1][1] = 1.0 / sy;
  if (camera.orthographic) {
    viewFromClip[2][2] = farPlane - nearPlane;
    viewFromClip[3][2] = nearPlane;
    viewFromClip[3][3] = 1.0;
  } else {
    viewFromClip[3][2] = 1.0;  // depth along the view = clip w
    viewFromClip[3][3] = 1.0 / nearPlane;
    viewFromClip[2][3] = 1.0 / farPlane - 1.0 / nearPlane;
  }
  const glm::dmat4 localFromView(glm::dvec4(right, 0), glm::dvec4(up, 0), glm::dvec4(forward, 0), glm::dvec4(eye, 1));

  GpuCamera gpu{};
  gpu.viewProjection = glm::mat4(clip);
  gpu.inverseViewProjection = glm::mat4(localFromView * viewFromClip);
  gpu.position = glm::vec3(eye);
  gpu.znear = static_cast<float>(nearPlane);
  gpu.zfar = static_cast<float>(farPlane);
  gpu.orthographic = camera.orthographic ? 1 : 0;
  gpu.size = size;
  return gpu;
}

void drawForward(Frame& frame, const SceneOnDevice& scene, const ShadowMaps& shadows, const IndirectInputs& indirect,
                 const Buffer& camera, const ShadeParams& shade, Targets& targets) {
  const std::vector<Draw>& draws = scene.scene.draws;

  // Depth prepass: masked materials look at their textures here, so that shading writes each pixel once.
  drawDepth(frame, scene,
            {.stage = "RE Depth", .target = targets.depth, .projections = camera, .clear = 1, .cull = true});

  // Background: zero in every target.
  const auto shadedTargets = {&targets.normal, &targets.geometric, &targets.albedo,   &targets.f0,
                              &targets.direct, &targets.highlight, &targets.indirect, &targets.emitted};
  SamplerDesc nearest{Wrap::Clamp, Wrap::Clamp};
  nearest.linearMag = nearest.linearMin = nearest.mips = nearest.linearMips = false;
  Pass background = frame.pass("RE Forward");
  background.shader("forward/background.comp").sample(targets.depth, sampler(frame.context().device, nearest));
  for (const Image* image : shadedTargets) background.write(*image);
  background.dispatch(uint64_t{targets.size.x} * targets.size.y);

  // Shading, material by material.
  ForwardPush push{};
  push.scene = scene.record.address;
  push.camera = camera.address;
  push.materials = scene.materials.address;
  push.lights = scene.lights.address;
  push.lightCount = static_cast<uint32_t>(scene.lightValues.size());
  push.sampling = indirect.sample;
  push.shadowBias = shade.shadowBias;
  push.specularDirect = shade.specularDirect;
  const bool fromVolume = indirect.volume != nullptr && indirect.grid != nullptr && indirect.sample.gated == 0;
  const bool fromFacets = !fromVolume && indirect.grid != nullptr && indirect.shaded != nullptr;
  const bool emitters = indirect.shadedEmitted != nullptr && scene.anyEmission;

  // What the scene does not have is left out of the shader. Untextured materials have a pass of their own: a device
  // that runs both sides of a branch would otherwise fetch five textures that are not there.
  for (const bool textured : {false, true}) {
    if (std::none_of(draws.begin(), draws.end(),
                     [&](const Draw& d) { return hasFlag(scene, d, kAnyTexture) == textured; }))
      continue;
    Pass pass = frame.pass("RE Forward");
    pass.shaders({"forward/forward.vert", fromVolume ? "forward/forward_volume.frag" : "forward/forward.frag"});
    pass.constant(0, shadowKinds(scene))
        .constant(1, textured)
        .constant(2, std::clamp(shade.pcf, 1u, 5u) | 1u)
        .constant(3, push.lightCount > UNIFORM_LIGHTS);
    pass.read(scene.record, scene.positions, scene.normals, scene.tangents, scene.uv0, scene.uv1, scene.colors,
              scene.indices, scene.materials, scene.lights, camera);
    pass.sample(shadows.flat, shadows.sampler).sample(shadows.cubes, shadows.sampler);
    if (fromVolume) {
      push.grid = indirect.grid->address;
      pass.read(*indirect.grid);
      SamplerDesc linear{Wrap::Clamp, Wrap::Clamp};
      linear.mips = linear.linearMips = false;
      pass.sample(*indirect.volume, sampler(frame.context().device, linear));
    }
    pass.uniform(scene.lights);
    for (const Image* image : shadedTargets) pass.color(*image);
    pass.depth(targets.depth, /*write*/ false).depthCompare(VK_COMPARE_OP_EQUAL).run([&](Commands& commands) {
      for (const Draw& draw : draws) {
        if (hasFlag(scene, draw, kAnyTexture) != textured) continue;
        const GpuMaterial& material = scene.materialValues.at(draw.material);
        push.material = draw.material;
        push.baseColor = material.baseColor;
        push.emission = material.emission;
        push.metallic = material.metallic;
        push.roughness = material.roughness;
        push.flags = material.flags;
        commands.cull(culling(scene, draw));
        commands.bindMaterial(scene.materialSets.at(draw.material));
        commands.push(push);
        commands.draw(draw.indexCount, draw.firstIndex);
      }
    });
  }
  if (fromVolume) return;

  // Indirect light of the facets: in compute, where no lane is spent outside a triangle.
  if (!fromFacets) {
    for (const Image* image : {&targets.indirect, &targets.emitted})
      frame.pass("RE Forward").clear(*image, ClearColor{});
    return;
  }
  IndirectPush lookup{};
  lookup.camera = camera.address;
  lookup.grid = indirect.grid->address;
  lookup.shape = indirect.shape->address;
  lookup.reverse = indirect.reverse->address;
  lookup.around = indirect.around->address;
  lookup.shaded = indirect.shaded->address;
  lookup.shadedEmitted = emitters ? indirect.shadedEmitted->address : 0;
  lookup.sampling = indirect.sample;
  lookup.size = targets.size;
  Pass pass = frame.pass("RE Forward");
  pass.shader("forward/indirect.comp")
      .constant(0, indirect.normalEncoding)
      .constant(1, emitters)
      .read(camera, *indirect.grid, *indirect.shape, *indirect.reverse, *indirect.around, *indirect.shaded)
      .write(targets.indirect, targets.emitted);
  if (emitters) pass.read(*indirect.shadedEmitted);
  pass.push(lookup).run(
      [&](Commands& commands) { commands.dispatchGroups((targets.size.x + 7) / 8, (targets.size.y + 7) / 8); });
}

}  // namespace irad
