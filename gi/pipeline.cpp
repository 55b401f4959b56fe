#include "gi/pipeline.h"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "gi/brute_force.h"
#include "gi/pipeline_impl.h"
#include "gi/watch.h"
#include "renderer/base/error.h"
#include "renderer/scene/material_edits.h"

namespace irad {

Pipeline::Pipeline(Context& context, Scene scene, const Settings& settings, ExpectedIrradiance expected)
    : impl_(std::make_unique<Impl>(context, std::move(scene), settings, std::move(expected))) {}
Pipeline::~Pipeline() = default;

Pipeline::Impl& Pipeline::changed() {
  impl_->state = Impl::newState();
  return *impl_;
}

const Scene& Pipeline::scene() const {
  return impl_->scene;
}
SceneOnDevice& Pipeline::device() {
  return impl_->onDevice;
}
const Settings& Pipeline::settings() const {
  return impl_->settings;
}
const Settings& Pipeline::obeyed() const {
  return impl_->planned.settings();
}
EffectPlan Pipeline::plan(std::optional<bool> redraw) const {
  SceneTraits traits = impl_->planned.traits;
  traits.light = impl_->lightState();
  traits.redraw = redraw;
  return irad::plan(traits, impl_->settings, &impl_->planned.plan());
}
const SceneTraits& Pipeline::traits() const {
  return impl_->planned.traits;
}

Redo Pipeline::set(const Settings& settings) {
  Impl& p = changed();
  p.lookAtRegion(p.regionWith(settings));
  p.settings = settings;
  p.lookAgain();
  return p.due();
}

Redo Pipeline::due(const Settings& settings) const {
  const Impl& p = *impl_;
  SceneTraits traits = p.planned.traits;
  traits.sky = makeSky(settings.sky, skyInputs(p.scene, p.scene.lights), &p.sky).largest();
  traits.region = p.regionWith(settings);
  SceneContent content = p.content;
  content.region = Impl::regionKey(traits.region);
  const EffectPlan plan = irad::plan(traits, settings, &p.planned.plan());
  return firstDifference(p.made, stageKeys(content, irad::obeyed(settings, plan)));
}

void Pipeline::setRegion(const std::optional<RegionBox>& box) {
  Impl& p = changed();
  p.scene.region = box;
  p.lookAtRegion(regionOrWhole(p.scene, p.settings));
  p.lookAgain();
}

void Pipeline::setLights(std::vector<Light> lights) {
  Impl& p = changed();
  for (const Light& light : lights)
    if (const std::string problem = unsound(light); !problem.empty()) throw UsageError(problem);
  std::vector<GpuLight> values = p.withSun(lights);
  const auto start = Impl::Clock::now();
  const Planned planned = p.planned;
  const SceneContent content = p.content;
  const Sky sky = p.sky;
  try {
    p.lookAtSky(lights);
    p.lookAtLights(values);
    const uint64_t key = p.shadowKey(values);
    std::optional<ShadowMaps> maps;
    if (p.shadows && p.shadowsMade == key)
      keepShadows(values, p.onDevice.lightValues);
    else
      maps = drawShadows(p.context, p.onDevice, values, p.settings.light.shadowResolution, p.shadowNeeds());
    p.onDevice.setLights(p.context, std::move(values), p.shadowNeeds().shines);
    if (maps) p.shadows = std::move(maps);
    p.shadowsMade = p.shadowsWanted = key;
  } catch (...) {
    p.planned = planned;
    p.content = content;
    p.sky = sky;
    p.shadowsWanted = p.shadowKey(p.onDevice.lightValues);
    throw;
  }
  p.scene.lights = std::move(lights);
  p.endFrame(start, /*setup=*/false);
}

void Pipeline::setMaterials(std::vector<MaterialEdit> edits) {
  Impl& p = changed();
  std::vector<Material> materials = editedMaterials(p.scene, edits);
  for (const Material& material : materials)
    if (const std::string problem = unsound(material, p.scene.images.size()); !problem.empty())
      throw UsageError(problem);
  const Planned planned = p.planned;
  const SceneContent content = p.content;
  if (p.scene.fileMaterials.empty()) p.scene.fileMaterials = p.scene.materials;
  std::swap(p.scene.materials, materials);
  try {
    p.lookAtSurfaces(p.scene.materials, p.content);
    measureMaterials(p.scene, p.scene.materials, p.planned.traits);
    p.lookAgain();
  } catch (...) {
    p.planned = planned;
    p.content = content;
    std::swap(p.scene.materials, materials);
    throw;
  }
  p.scene.materialEdits = std::move(edits);
}

Redo Pipeline::due(const std::vector<MaterialEdit>& edits) const {
  const Impl& p = *impl_;
  const std::vector<Material> materials = editedMaterials(p.scene, edits);
  SceneContent content = p.content;
  p.lookAtSurfaces(materials, content);
  SceneTraits traits = p.planned.traits;
  measureMaterials(p.scene, materials, traits);
  const EffectPlan plan = irad::plan(traits, p.settings, &p.planned.plan());
  return firstDifference(p.made, stageKeys(content, irad::obeyed(p.settings, plan)));
}

bool Pipeline::adopt(Scene& scene) {
  Impl& p = changed();
  const SurfaceContent surfaces(scene);
  const std::vector<Material>&mine = fileMaterials(p.scene), &its = fileMaterials(scene);
  if (surfaces.surfaces(its) != p.surfaces.surfaces(mine) || surfaces.materials(its) != p.surfaces.materials(mine))
    return false;
  setLights(scene.lights);
  setMaterials(scene.materialEdits);
  p.scene = std::move(scene);                          // where p.onDevice looks for it
  p.lookAtRegion(regionOrWhole(p.scene, p.settings));  // cameras have a say in it
  p.lookAgain();
  return true;
}

void Pipeline::lightsChanged() {
  Impl& p = changed();
  p.shadowsMade = 0;
  p.made.forget(Redo::Gather);
}

void Pipeline::setSky(std::shared_ptr<const SkyImage> image) {
  Impl& p = changed();
  p.scene.sky = std::move(image);
  p.lookAgain();
}
const Sky& Pipeline::sky() const {
  return impl_->sky;
}

void Pipeline::darken() {
  Impl& p = changed();
  if (!p.now.light) return;
  if (*p.now.light) p.now.light = makeLighting(p.context, *p.now.facets, p.planned.settings());
  for (const Redo gone : {Redo::Emission, Redo::Gather}) p.made.forget(gone);
}

void Pipeline::invalidate(Redo from) {
  impl_->made.forget(from);
}

void Pipeline::prepare(const Progress& progress, uint32_t maxSweeps) {
  Impl& p = changed();
  p.context.timings.about(fmt::format("{}, {} voxels", p.scene.path.stem().string(), p.settings.voxel.resolution));
  if (p.shadowsDue()) {
    p.lookAtLights(p.onDevice.lightValues);  // they may have been edited there
    p.redrawShadows();
  }
  p.prepare(maxSweeps, progress);
}

bool Pipeline::asleep() const {
  if (impl_->settings.effects.relight == EffectMode::on) return false;
  return current() && (!impl_->relights() || (impl_->now.light->report.settled() && !impl_->reflectionsDue()));
}

WritebackRounds Pipeline::settleReflections(const Camera& camera, Targets& targets, const Progress& progress) {
  Impl& p = *impl_;
  WritebackRounds done;
  if (!p.now.light || !p.now.light->writeback.used) return done;
  float least = std::numeric_limits<float>::infinity();  // change of a round
  uint32_t since = 0;                                    // rounds since it was halved
  while (!done.settled && done.rounds < WritebackRounds::kMost && since < WritebackRounds::kPatience) {
    if (progress && !progress("GI Writeback", static_cast<float>(done.rounds) / WritebackRounds::kMost))
      throw WorkError("cancelled");
    ++done.rounds;
    Frame frame = p.context.begin(p.frameIndex);
    render(frame, camera, VIEW_LIT, targets);
    frame.submitAndWait();
    done.settled = !p.reflectionsDue();
    if (done.settled) break;
    const float change = p.now.light->writeback.report->change;
    since = change <= 0.5f * least ? 0 : since + 1;
    if (since == 0) least = change;
    prepare(progress);
  }
  return done;
}

bool Pipeline::current() const {
  const Impl& p = *impl_;
  const Redo needed = p.relights() ? Redo::Scatter : Redo::Matrix;
  return p.due() > needed && !p.shadowsDue() && p.now.light && p.fieldFits(p.now);
}

void Pipeline::solvedAfresh(const Progress& progress, const std::function<void()>& draw) {
  Impl& p = changed();
  IRAD_CHECK(current(), "what the settings call for has not been prepared");
  if (progress && !progress("GI Solve", 0)) throw WorkError("cancelled");
  // The mean over the frames begins in the dark in any case.
  if (p.framewise() && p.now.light->report.settled()) return draw();
  struct Before {
    Impl& p;
    std::optional<Lighting> light = std::exchange(p.now.light, std::nullopt);
    uint64_t solvedFrame = p.solvedFrame;
    Planned planned = p.planned;
    ~Before() {
      p.state = Impl::newState();
      p.planned = std::move(planned);
      p.now.light = std::move(light);
      p.solvedFrame = solvedFrame;
    }
  } before{p};
  p.relight(p.now, StagesDue::from(Redo::Emission), /*maxSweeps=*/0, progress);
  draw();
}

void Pipeline::showLight(std::span<const glm::vec4> indirect, std::span<const glm::vec4> radiosity) {
  Impl& p = changed();
  IRAD_CHECK(current() && *p.now.light, "no light has been prepared");
  const auto put = [&](const Buffer& buffer, std::span<const glm::vec4> values) {
    if (values.empty()) return;
    IRAD_CHECK_OP(values.size(), ==, p.now.facets->count);
    upload(p.context, buffer, std::as_bytes(values));
  };
  put(p.now.light->indirect, indirect);
  put(p.now.light->radiosity, radiosity);
  ++p.revision.light;
  p.scatterInto(p.now);
}

void Pipeline::goOn(const SavedFrames& frames) {
  Impl& p = changed();
  IRAD_CHECK(current() && *p.now.light && p.framewise(), "no frames to go on with");
  restoreFrames(p.context, *p.now.light, frames);
  ++p.revision.light;
  p.showSolved(p.now);
}

std::vector<Finding> Pipeline::findings() const {
  const Products& p = impl_->now;
  if (!p.light) return {};
  const Grid& grid = p.facets->grid;
  std::vector<Finding> all =
      irad::findings(p.light->report, grid, impl_->scene.origin + glm::dvec3(grid.origin), impl_->solvedFrame);
  if (const std::vector<uint32_t> lights = lightsWithoutShadow(); !lights.empty())
    all.push_back({Finding::Severity::Warning, describeWithoutShadow(impl_->scene.lights, lights)});
  return all;
}

std::vector<uint32_t> Pipeline::lightsWithoutShadow() const {
  const std::vector<GpuLight>& lights = impl_->onDevice.lightValues;
  const LightFilter shines = impl_->shadowNeeds().shines;
  std::vector<uint32_t> without;
  for (uint32_t i = 0; impl_->shadows && i < impl_->scene.lights.size(); ++i)
    if (lights[i].shadowLayer < 0 && shines(lights[i])) without.push_back(i);
  return without;
}

Revision Pipeline::revision() const {
  return impl_->revision;
}
const FacetList& Pipeline::facets() const {
  return *impl_->now.facets;
}
const Field& Pipeline::field() const {
  return *impl_->now.field;
}
const FormFactors& Pipeline::matrix() const {
  return *impl_->now.matrix;
}
const Lighting& Pipeline::lighting() const {
  return *impl_->now.light;
}
const ShadowMaps& Pipeline::shadows() const {
  return *impl_->shadows;
}

}  // namespace irad
