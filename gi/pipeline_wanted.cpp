// What settings and scene ask of the pipeline: the plan, the contents that stages are keyed by, lights and sky.
#include <algorithm>
#include <atomic>
#include <utility>

#include "gi/pipeline_impl.h"
#include "gi/voxelize.h"
#include "renderer/base/error.h"

namespace irad {

uint64_t Pipeline::Impl::newState() {
  static std::atomic<uint64_t> last = 0;
  return ++last;
}

Pipeline::Impl::Impl(Context& c, Scene s, const Settings& wanted, ExpectedIrradiance h)
    : context(c),
      scene(std::move(s)),
      expected(std::move(h)),
      settings(wanted),
      planned(scene, wanted),
      onDevice(c, scene),
      camera(c.device, "Camera", Subsystem::Targets, sizeof(GpuCamera)),
      surfaces(scene) {
  content = {.lights = lightContent(onDevice.lightValues)};
  lookAtRegion(planned.traits.region);
  lookAtSurfaces(scene.materials, content);
  lookAtSky(scene.lights);
  useSun();
  decide();
}

void Pipeline::Impl::decide() {
  planned.decide(settings);
  // With the settings that the present voxels were made with, what those voxels have shown holds again.
  if (!planned.traits.build && now.facets && due() > Redo::Voxels) {
    learn(now);
    planned.decide(settings);
  }
  useMaterials();
  shadowsWanted = shadowKey(onDevice.lightValues);
}

ShadowNeeds Pipeline::Impl::shadowNeeds() const {
  ShadowNeeds needs = irad::shadowNeeds(settings);
  needs.shines = [this](const GpuLight& light) { return planned.shines(light, scene, settings); };
  needs.alphaTest = planned.on(Effect::alphaTest) || planned.on(Effect::glass);
  needs.tinted = planned.tinted();
  needs.kernels = rasterizesByKernels(context.device, settings);
  return needs;
}

uint64_t Pipeline::Impl::shadowKey(std::span<const GpuLight> lights) const {
  Digest digest;
  digest.add(content.surfaces)
      .add(planned.on(Effect::alphaTest))
      .add(planned.on(Effect::glass))
      .add(planned.tinted())
      .add(settings.light.shadowResolution);
  const ShadowNeeds needs = shadowNeeds();
  digest.add(needs.filter).add(needs.bleedReduction).add(needs.points);
  if (needs.filter == ShadowFilter::vsm) digest.add(needs.taps);
  const std::vector<int> layers = shadowLayers(context.device, lights, needs);
  for (size_t i = 0; i < lights.size(); ++i) digest.add(layers[i]).add(shadowContent(lights[i]));
  return digest.value();
}

void Pipeline::Impl::useMaterials() {
  std::vector<GpuMaterial> wanted = gpuMaterials(planned.materials(scene.materials));
  const auto bytes = [](const auto& v) { return std::as_bytes(std::span(v)); };
  if (!std::ranges::equal(bytes(wanted), bytes(onDevice.materialValues)))
    onDevice.setMaterials(context, std::move(wanted));
}

void Pipeline::Impl::lookAtSurfaces(const std::vector<Material>& of, SceneContent& in) const {
  in.surfaces = surfaces.surfaces(of);
  in.materials = surfaces.materials(of);
  in.emission = surfaces.emission(of);
}

void Pipeline::Impl::lookAtLights(std::span<const GpuLight> lights) {
  planned.traits.lights.clear();
  for (const GpuLight& light : lights)
    planned.traits.lights.push_back(measureLight(light, scene, settings.voxel.resolution));
  content.lights = lightContent(lights);
  decide();
}

void Pipeline::Impl::lookAtSky(std::span<const Light> lights) {
  sky = makeSky(settings.sky, skyInputs(scene, lights), &sky);
  planned.traits.sky = sky.largest();
  content.sky = scene.sky ? Digest().add(std::as_bytes(std::span(scene.sky->sha256))).value() : 0;
}

SceneRegion Pipeline::Impl::regionWith(const Settings& wanted) const {
  const bool same =
      wanted.scene.region == settings.scene.region && wanted.matrix.gpu.hitRule == settings.matrix.gpu.hitRule;
  return same ? planned.traits.region : regionOrWhole(scene, wanted);
}

SceneShape Pipeline::Impl::shape() {
  if (!repeats) repeats = samePlaces(scene);
  const bool boxed = settings.scene.region.mode == RegionMode::box || scene.region;
  return {boxed ? regionOf(scene, settings) : planned.traits.region, *repeats};
}

void Pipeline::Impl::lookAtRegion(const SceneRegion& now) {
  planned.traits.region = now;
  content.region = regionKey(now);
}

void Pipeline::Impl::lookAgain() {
  lookAtSky(scene.lights);
  const bool moved = useSun();
  lookAtLights(onDevice.lightValues);
  if (!moved || !shadows || !shadowsDue()) return;
  try {
    redrawShadows();
  } catch (const Error&) {
    // Its shadows are still due: prepare() says what is in the way.
  }
}

std::optional<SkySun> Pipeline::Impl::skySun() const {
  const bool may = settings.effects.sky != EffectMode::off && settings.matrix.gpu.hitRule == HitRule::triangles;
  return may ? sky.sun : std::nullopt;
}

std::vector<GpuLight> Pipeline::Impl::withSun(std::vector<Light> lights) const {
  if (const std::optional<SkySun> sun = skySun()) {
    const float most = std::max({sun->irradiance.x, sun->irradiance.y, sun->irradiance.z});
    lights.push_back({.name = "sun of the sky",
                      .type = LightType::Sun,
                      .direction = -sun->towards,
                      .color = sun->irradiance / most,
                      .intensity = most});
  }
  return gpuLights(lights, scene.origin);
}

bool Pipeline::Impl::useSun() {
  if (skySun() == sunUsed) return false;
  sunUsed = skySun();
  std::vector<GpuLight> values = withSun(scene.lights);
  if (shadows && shadowsMade == shadowKey(values)) keepShadows(values, onDevice.lightValues);
  onDevice.setLights(context, std::move(values), shadowNeeds().shines);
  return true;
}

void Pipeline::Impl::redrawShadows() {
  const auto start = Clock::now();
  shadows = drawShadows(context, onDevice, settings.light.shadowResolution, shadowNeeds());
  shadowsMade = shadowsWanted;
  endFrame(start, /*setup=*/false);
}

LightState Pipeline::Impl::lightState() const {
  LightState state = planned.traits.light;
  state.due =
      std::min({due(), shadowsDue() ? Redo::Gather : Redo::Nothing, reflectionsDue() ? Redo::Solve : Redo::Nothing});
  if (now.light) state.report = now.light->report;
  return state;
}

}  // namespace irad
