#include "gi/check/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "gi/check/cases.h"
#include "renderer/base/error.h"
#include "renderer/base/near_match.h"
#include "renderer/scene/material_edits.h"
#include "renderer/scene/nodes.h"

namespace irad {
namespace {
constexpr std::string_view kScheme = "check:";
}  // namespace

std::span<const CheckCase> checkCases() {
  static const std::vector<CheckCase> all = [] {
    std::vector<CheckCase> cases;
    for (const auto group :
         {furnaceCases, skyCases, formFactorCases, energyCases, limitCases, rangeCases, inputCases, leakCases,
          roomCases, glassCases, samplingCases, writebackCases, stabilityCases, guardCases}) {
      const std::vector<CheckCase> more = group();
      cases.insert(cases.end(), more.begin(), more.end());
    }
    return cases;
  }();
  return all;
}

const CheckCase& findCheckCase(std::string_view name) {
  std::vector<std::string> names;
  for (const CheckCase& check : checkCases()) {
    if (name == check.name) return check;
    names.emplace_back(check.name);
  }
  throw UsageError(fmt::format("unknown case '{}'{}", name, suggestion(name, names)));
}

bool isCheckScene(const std::filesystem::path& path) {
  return path.native().starts_with(kScheme);
}

Scene openScene(const std::filesystem::path& path, const LoadOptions& options) {
  if (!isCheckScene(path)) return loadScene(path, options);
  const CheckCase& check = findCheckCase(path.native().substr(kScheme.size()));
  if (check.scene == nullptr) throw UsageError(fmt::format("the case '{}' has no scene: {}", check.name, check.setup));
  Scene scene = check.scene();
  scene.path = path;
  scene.fileLights = scene.lights;
  if (options.lights) replaceLights(scene, *options.lights);
  if (options.materials) replaceMaterialEdits(scene, *options.materials);
  for (const std::string& unknown : unknownMaterials(scene, scene.materialEdits)) scene.warnings.push_back(unknown);
  for (const std::string& unknown : unknownNodes(scene.nodes, options.hidden.value_or(HiddenNodes{})))
    scene.warnings.push_back(unknown);
  scene.sky = options.sky;
  return scene;
}

ExpectedIrradiance expectedIrradiance(const Scene& scene) {
  if (!isCheckScene(scene.path)) return {};
  return findCheckCase(scene.path.native().substr(kScheme.size())).expected;
}

bool CheckOutcome::passed() const {
  return error.empty() &&
         std::all_of(figures.begin(), figures.end(), [](const CheckFigure& figure) { return figure.passed(); });
}

const CheckFigure* CheckOutcome::find(const std::string& figure) const {
  const auto found = std::find_if(figures.begin(), figures.end(), [&](const auto& f) { return f.name == figure; });
  return found != figures.end() ? &*found : nullptr;
}

const CheckFigure* CheckOutcome::decisive(const CheckOutcome* beside) const {
  const auto strains = [&](const CheckFigure& figure) {
    const CheckFigure* other = beside != nullptr ? beside->find(figure.name) : nullptr;
    return std::pair(figure.strain, other != nullptr ? other->strain : 0.0);
  };
  const CheckFigure* worst = nullptr;
  for (const CheckFigure& figure : figures)
    if (!figure.mark.empty() && (worst == nullptr || strains(figure) > strains(*worst))) worst = &figure;
  return worst != nullptr || figures.empty() ? worst : &figures.front();
}

CheckOutcome runCheck(Context& context, const CheckCase& check, const Settings& settings, const CheckOptions& options) {
  IRAD_CHECK(check.run != nullptr, "{} is pending", check.name);
  const auto start = std::chrono::steady_clock::now();
  CheckRun run(context, settings, options);
  CheckOutcome outcome;
  try {
    check.run(run);
  } catch (const Error& error) {
    outcome.error = error.what();
  }
  context.device.waitIdle();
  outcome.figures = std::move(run.figures);
  outcome.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return outcome;
}

void applyCheckSizes(Settings& settings) {
  settings.voxel.resolution = 64;
  settings.matrix.gpu.rays = 384;
  settings.sample.emitters = EmitterLookup::automatic;
}

Settings thesisBeside(const Settings& settings) {
  Settings thesis = settings;
  applyPreset(thesis, "thesis");
  thesis.voxel.resolution = settings.voxel.resolution;
  thesis.matrix.gpu.rays = settings.matrix.gpu.rays;
  return thesis;
}

}  // namespace irad
