#include "gi/check/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "gi/check/cases.h"
#include "gi/check/families.h"
#include "renderer/base/error.h"
#include "renderer/base/near_match.h"
#include "renderer/scene/material_edits.h"
#include "renderer/scene/nodes.h"

namespace irad {
namespace {

constexpr std::string_view kScheme = "check:";

/// The case and, of a family, the member that "check:NAME" or "check:NAME:SEED:N" names.
struct Named {
  const CheckCase& check;
  uint64_t seed = 1;
  uint32_t resolution = 0;
};

Named parseName(const std::filesystem::path& path) {
  const std::string text = path.native().substr(kScheme.size());
  const size_t name = std::min(text.find(':'), text.size()), seed = std::min(text.find(':', name + 1), text.size());
  Named named{.check = findCheckCase(text.substr(0, name))};
  if (name < text.size() && named.check.family == nullptr)
    throw UsageError(
        fmt::format("{}: the case '{}' is one scene, not a family with seeds", path.string(), named.check.name));
  Settings given;
  applyCheckSizes(given);
  given.matrix.gpu.seed = 1;
  if (name < text.size()) applySetting(given, "matrix.seed=" + text.substr(name + 1, seed - name - 1));
  if (seed < text.size()) applySetting(given, "voxel.resolution=" + text.substr(seed + 1));
  named.seed = given.matrix.gpu.seed;
  named.resolution = given.voxel.resolution;
  return named;
}

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

const CheckCase& caseOf(const std::filesystem::path& path) {
  return parseName(path).check;
}

Scene openScene(const std::filesystem::path& path, const LoadOptions& options) {
  if (!isCheckScene(path)) return loadScene(path, options);
  const Named named = parseName(path);
  const CheckCase& check = named.check;
  if (!check.scene && !check.family)
    throw UsageError(fmt::format("the case '{}' has no scene: {}", check.name, check.setup));
  Scene scene = check.family ? familyMember(*check.family, named.seed, named.resolution).scene : check.scene();
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
  return caseOf(scene.path).expected;
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
