// The presets and the defaults by device class (docs/method.md).
#include <fmt/format.h>

#include "gi/plan.h"
#include "gi/settings.h"
#include "renderer/base/error.h"
#include "renderer/base/near_match.h"

namespace irad {
namespace {

/// T Table 5 and the algorithms behind it: 256 voxels, 384 rays, "3axis" normals, DDA, padded rows, blurred and
/// premultiplied lookups, two specular rays in the fragment shader, edge removal off, lambda = 0.8 (T 7.10, RQ9).
void thesis(Settings& s) {
  s.voxel = {256, VoxelMethod::raster, NormalEncoding::axis26};
  s.field.method = FieldMethod::jfa;
  s.matrix.format = MatrixFormat::padded;
  s.matrix.gpu.rays = 384;
  s.matrix.emitterSampling = EffectMode::off;
  s.matrix.gpu.hitRule = HitRule::thesis;
  s.matrix.gpu.traversal = Traversal::dda;
  s.matrix.gpu.jitter = 1;  // "a jittered Hammersley sequence" (T 5.4)
  s.solver.gpu.lambda = 0.8f;
  s.solver.kernel = SolverKernel::tree;
  s.solver.acceleration = SolverAcceleration::off;
  s.scatter.edgeRemoval = false;
  s.sample.gpu.filter_ = SampleFilter::blur;
  s.sample.gpu.premultiplied = 1;
  s.specular.mode = SpecularMode::fragment;
  s.specular.gpu.rays = 2;
  s.specular.gpu.traversal = Traversal::dda;
  s.specular.gpu.filter_ = 0;
  s.specular.gpu.metalRoughness = s.specular.gpu.maxRoughness;
  s.light.shadowResolution = 2048;
  s.light.points = 32;
  // The thesis's stages run whatever the scene holds. But lights without intensity stay out, and light at rest is not
  // solved again.
  forceEffects(s, EffectMode::on);
  s.effects.relight = EffectMode::automatic;
  for (const LightKind& kind : lightKinds()) s.effects.*effectInfo(effectOf(kind.type)).mode = EffectMode::automatic;
}

void fast(Settings& s, bool cpuDevice) {
  s.voxel.resolution = cpuDevice ? 48 : 128;
  s.matrix.gpu.rays = cpuDevice ? 64 : 128;
  s.solver.tolerance = 2e-2f;
  s.specular.gpu.rays = 1;
  s.light.shadowResolution = cpuDevice ? 1024 : 2048;
}

void reference(Settings& s, bool cpuDevice) {
  s.voxel.resolution = cpuDevice ? 128 : 512;
  s.matrix.gpu.rays = cpuDevice ? 512 : 384;
  s.solver.tolerance = 1e-4f;
  s.sample.emitters = EmitterLookup::pixels;
  s.sample.emitterRays = 32;
  s.specular.gpu.rays = 32;
  s.specular.gpu.filter_ = 0;
  s.light.shadowResolution = cpuDevice ? 4096 : 8192;
}

}  // namespace

std::vector<std::string> presetNames() {
  return {"thesis", "fast", "balanced", "reference"};
}

Settings defaultSettings(bool cpuDevice) {
  Settings settings;
  settings.voxel.resolution = cpuDevice ? 64 : 256;
  settings.matrix.gpu.rays = cpuDevice ? 128 : 384;
  settings.light.shadowResolution = cpuDevice ? 2048 : 4096;
  if (cpuDevice) {
    settings.sample.emitters = EmitterLookup::facets;  // rays of pixels would take longer than all else
    settings.matrix.emitterSamples = 128;              // which the host traces
  }
  return settings;
}

void applyPreset(Settings& settings, std::string_view name, bool cpuDevice) {
  Settings preset = defaultSettings(cpuDevice);  // "balanced" is the default itself
  if (name == "thesis")
    thesis(preset);
  else if (name == "fast")
    fast(preset, cpuDevice);
  else if (name == "reference")
    reference(preset, cpuDevice);
  else if (name != "balanced")
    throw UsageError(fmt::format("unknown preset '{}'{}", name, suggestion(name, presetNames())));
  preset.matrix.gpu.seed = settings.matrix.gpu.seed;
  preset.camera.exposureEv = settings.camera.exposureEv;
  preset.camera.autoExposure = settings.camera.autoExposure;
  preset.camera.gpu.toneCurve = settings.camera.gpu.toneCurve;
  preset.view = settings.view;
  preset.sky = settings.sky;
  preset.rasterizer = settings.rasterizer;
  preset.scene = settings.scene;
  settings = preset;
}

}  // namespace irad
