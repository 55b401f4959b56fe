#include "renderer/forward.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "renderer/depth_pass.h"
#include "renderer/raster.h"
#include "renderer/resolve.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/passes.h"

namespace irad {
namespace {

bool hasFlag(const SceneOnDevice& scene, const Draw& draw, uint32_t flag) {
  return (scene.materialValues.at(draw.material).flags & flag) != 0;
}

VkCullModeFlags culling(const SceneOnDevice& scene, const Draw& draw) {
  return hasFlag(scene, draw, MATERIAL_DOUBLE_SIDED) ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT;
}

constexpr uint32_t kAnyTexture = MATERIAL_BASE_COLOR_TEXTURE | MATERIAL_METALLIC_ROUGHNESS_TEXTURE |
                                 MATERIAL_NORMAL_TEXTURE | MATERIAL_OCCLUSION_TEXTURE | MATERIAL_EMISSIVE_TEXTURE |
                                 MATERIAL_TRANSMISSION_TEXTURE;

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

GpuCamera makeGpuCamera(const Scene& scene, const Camera& camera, glm::uvec2 size) {
  // Camera axes in local space; the position relative to the scene's origin in double precision.
  const glm::dvec3 eye = camera.position - scene.origin;
  const glm::dmat3 axes = glm::mat3_cast(glm::dquat(glm::normalize(camera.orientation)));
  const glm::dvec3 right = axes[0], up = axes[1], forward = -axes[2];

  // Planes as the file gives them; the far one from the bounds where it gives none.
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

  // Clip = projection x view, y up (the frame flips the viewport). Depth is reversed, 1 at the near plane and 0 at the
  // far one: what fp32 keeps near 0 makes up for what the division takes, so that depths are told apart alike
  // everywhere.
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
    rows[2] = row(forward, -1.0 / (farPlane - nearPlane));
    rows[2].w += farPlane / (farPlane - nearPlane);
    rows[3] = {0, 0, 0, 1};
  } else {
    const double scale = nearPlane / (farPlane - nearPlane);
    rows[2] = row(forward, -scale);
    rows[2].w += farPlane * scale;
    rows[3] = row(forward, 1.0);
  }
  const glm::dmat4 clip = glm::transpose(rows);

  // The inverse, written down rather than computed: local = eye + axes x view.
  glm::dmat4 viewFromClip(0.0);  // columns: contributions of clip x, y, z, w to (right, up, forward, 1)
  viewFromClip[0][0] = 1.0 / sx;
  viewFromClip[1][1] = 1.0 / sy;
  if (camera.orthographic) {
    viewFromClip[2][2] = nearPlane - farPlane;
    viewFromClip[3][2] = farPlane;
    viewFromClip[3][3] = 1.0;
  } else {
    viewFromClip[3][2] = 1.0;  // depth along the view = clip w
    viewFromClip[3][3] = 1.0 / farPlane;
    viewFromClip[2][3] = 1.0 / nearPlane - 1.0 / farPlane;
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

void drawForward(Frame& frame, const SceneOnDevice& scene, const ShadowMaps& shadows, const Buffer& camera,
                 const ShadeParams& shade, Targets& targets, const ForwardEffects& all, const VolumeLookup& lookup) {
  Context& context = frame.context();
  const std::vector<Draw>& draws = scene.scene.draws;
  const bool inVolume = lookup.volume != nullptr;

  targets.fit(context, &Targets::f0, all.specular);
  targets.fit(context, &Targets::highlight, (all.highlights && shade.specularDirect != 0) || all.emission);
  targets.fit(context, &Targets::indirect, all.indirect);

  ForwardEffects effects = all;
  effects.specular &= all.wanted.reflections;
  effects.indirect &= all.wanted.indirect;
  if (!all.wanted.direct) {
    effects.lights = {};
    effects.emission = effects.highlights = false;
  }
  const bool highlights = effects.highlights && shade.specularDirect != 0;
  const Image none;
  const auto written = [&](bool wanted, const Image& target) -> const Image& { return wanted ? target : none; };
  const Image &f0 = written(effects.specular, targets.f0),
              &highlight = written(highlights || effects.emission, targets.highlight),
              &indirect = written(effects.indirect, targets.indirect);

  // Depth prepass: masked materials read their textures here, so that shading writes each pixel once.
  targets.fitRaster(context, effects.kernels, scene.scene.triangleCount());
  if (effects.kernels)
    rasterVisible(frame, scene, camera, effects.alphaTest, targets, effects.layer);
  else
    drawDepth(frame, scene,
              {.stage = "RE Depth",
               .target = targets.depth,
               .projections = camera,
               .cull = true,
               .alphaTest = effects.alphaTest,
               .blended = effects.layer != Layer::opaque,
               .peeled = effects.layer == Layer::behind ? &targets.peeled : nullptr});

  if (!all.wanted.surfaces) return;

  // Background: zero in every target.
  frame.pass("RE Forward")
      .shader("forward/background.comp")
      .constant(CONSTANT_TARGETS, targets.present())
      .sample(targets.depth, pointSampler(context.device))
      .write(targets.normal, targets.geometric, targets.albedo, targets.bound(&Targets::f0), targets.direct,
             targets.bound(&Targets::highlight), targets.bound(&Targets::indirect), targets.bound(&Targets::emitted))
      .dispatch(targets.size);

  // Shading, material by material: by drawing triangles, or over the listed pixels.
  if (effects.kernels) listPixels(frame, scene, targets);
  ForwardPush push{};
  push.sampling = lookup.sample;
  push.lightCount = static_cast<uint32_t>(scene.shining.size());
  push.shadowBias = shade.shadowBias;
  push.specularDirect = shade.specularDirect;
  const auto use = [&](Commands& commands, uint32_t index) {
    const GpuMaterial& material = scene.materialValues.at(index);
    push.material = index;
    push.baseColor = material.baseColor;
    push.emission = material.emission;
    push.metallic = material.metallic;
    push.roughness = material.roughness;
    push.flags = material.flags;
    commands.bindMaterial(scene.materialSets.at(index));
    commands.push(push);
  };

  SamplerDesc trilinear{Wrap::Clamp, Wrap::Clamp};
  trilinear.mips = trilinear.linearMips = false;

  // Untextured materials have a pass of their own: a device that runs both sides of a branch would otherwise fetch five
  // textures in vain.
  for (const bool textured : {false, true}) {
    const auto drawnHere = [&](const Draw& draw) { return hasFlag(scene, draw, kAnyTexture) == textured; };
    if (std::none_of(draws.begin(), draws.end(), drawnHere)) continue;
    Pass pass = frame.pass("RE Forward");
    if (effects.kernels)
      pass.shader(inVolume ? "forward/resolve_volume.comp" : "forward/resolve.comp");
    else
      pass.shaders({"forward/forward.vert", inVolume ? "forward/forward_volume.frag" : "forward/forward.frag"});
    specialize(pass, FORWARD_LIGHTS, effects.lights, scene.shining);
    pass.effect(FORWARD_TEXTURED, textured)
        .effect(FORWARD_NORMAL_MAP, effects.normalMap)
        .effect(FORWARD_EMISSION, effects.emission)
        .effect(FORWARD_HIGHLIGHTS, highlights)
        .effect(FORWARD_F0, effects.specular)
        .effect(FORWARD_INDIRECT, effects.indirect)
        .effect(FORWARD_GLASS, effects.glass)
        .effect(FORWARD_TINTED, effects.tinted)
        .constant(FORWARD_PCF, std::clamp(shade.pcf, 1u, 5u) | 1u)
        .constant(FORWARD_MANY_LIGHTS, push.lightCount > UNIFORM_LIGHTS);
    push.scene = pass.in(scene.record);
    push.camera = pass.in(camera);
    push.materials = pass.in(scene.materials);
    sampleShadows(pass, shadows);
    pass.uniform(scene.shiningLights);
    if (inVolume) {
      push.grid = pass.in(*lookup.grid);
      pass.sample(*lookup.volume, sampler(context.device, trilinear));
    }
    if (effects.kernels) {
      pass.constant(FORWARD_TARGETS,
                    (f0 ? TARGET_F0 : 0u) | (highlight ? TARGET_HIGHLIGHT : 0u) | (indirect ? TARGET_INDIRECT : 0u))
          .write(targets.normal, targets.geometric, targets.albedo, targets.bound(&Targets::f0), targets.direct,
                 targets.bound(&Targets::highlight), targets.bound(&Targets::indirect));
      if (!inVolume) pass.write(targets.linear);  // for the lookup
      push.lists = pass.in(targets.pixelLists);
      push.listed = pass.in(targets.listedPixels);
      pass.indirect(targets.pixelLists).run([&](Commands& commands) {
        std::set<uint32_t> materials;
        for (const Draw& draw : draws)
          if (drawnHere(draw)) materials.insert(draw.material);
        for (const uint32_t material : materials) {
          use(commands, material);
          commands.dispatchIndirect(targets.pixelLists, sizeof(PixelList) * material);
        }
      });
      continue;
    }
    pass.color(targets.normal)
        .color(targets.geometric)
        .color(targets.albedo)
        .colorIfAny(f0)
        .color(targets.direct)
        .colorIfAny(highlight)
        .colorIfAny(indirect);
    if (!inVolume) pass.colorIfAny(effects.indirect ? targets.linear : none);  // for the lookup
    pass.depth(targets.depth, /*write*/ false).depthCompare(VK_COMPARE_OP_EQUAL).run([&](Commands& commands) {
      for (const Draw& draw : draws) {
        if (!drawnHere(draw)) continue;
        commands.cull(culling(scene, draw));
        use(commands, draw.material);
        commands.draw(draw.indexCount, draw.firstIndex);
      }
    });
  }
}

}  // namespace irad
