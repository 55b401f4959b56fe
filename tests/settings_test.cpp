// The registry of settings: every one round-trips, refuses what is out of range, and names what the user may have
// meant.
#include "gi/settings.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "gi/sizes.h"
#include "renderer/error.h"
#include "renderer/near_match.h"

namespace irad {
namespace {

std::string usageError(const std::function<void()>& act) {
  try {
    act();
  } catch (const UsageError& error) {
    EXPECT_EQ(error.exitStatus, 2);
    return error.what();
  }
  return "(no error)";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Another allowed value of a setting than the one it has.
std::string otherValue(const SettingInfo& info) {
  if (info.kind == "switch") return info.value == "true" ? "false" : "true";
  if (info.kind == "choice") return info.choices.at(info.value == info.choices[0] ? 1 : 0);
  const double now = std::stod(info.value);
  const double other = now == info.meta.min ? info.meta.max : info.meta.min;
  return info.kind == "integer" ? fmt::format("{}", static_cast<uint64_t>(other)) : fmt::format("{}", other);
}

TEST(Settings, NamesAreUniqueGroupedAndDocumented) {
  std::set<std::string> names;
  for (const SettingInfo& info : settingInfos(Settings{})) {
    EXPECT_TRUE(names.insert(info.meta.name).second) << info.meta.name;
    EXPECT_TRUE(contains(info.meta.name, ".")) << info.meta.name;
    EXPECT_GT(std::string(info.meta.help).size(), 10u) << info.meta.name;
    if (info.kind == "integer" || info.kind == "number") {
      EXPECT_LT(info.meta.min, info.meta.max) << info.meta.name;
    }
  }
  EXPECT_GE(names.size(), 36u);
}

TEST(Settings, DefaultsLieInTheirRanges) {
  for (const bool cpu : {false, true}) {
    Settings settings = defaultSettings(cpu);
    for (const SettingInfo& info : settingInfos(settings))
      EXPECT_NO_THROW(applySetting(settings, fmt::format("{}={}", info.meta.name, info.value))) << info.meta.name;
    EXPECT_EQ(difference(settings, defaultSettings(cpu)), Redo::Nothing);
  }
}

TEST(Settings, EverySettingRoundTripsThroughTextAndJson) {
  for (const SettingInfo& info : settingInfos(Settings{})) {
    SCOPED_TRACE(info.meta.name);
    const std::string value = otherValue(info);
    Settings changed;
    applySetting(changed, fmt::format("{}={}", info.meta.name, value));
    EXPECT_NE(settingValue(changed, info.meta.name), info.value);
    EXPECT_EQ(difference(Settings{}, changed), info.meta.redo);

    Settings again;
    settingsFromJson(again, settingsToJson(changed));
    EXPECT_EQ(settingsToJson(again), settingsToJson(changed));
    EXPECT_EQ(settingValue(again, info.meta.name), settingValue(changed, info.meta.name));
    // Nothing else moved.
    const std::vector<SettingInfo> before = settingInfos(Settings{}), after = settingInfos(again);
    for (size_t i = 0; i < before.size(); ++i) {
      if (std::string(before[i].meta.name) == info.meta.name) continue;
      EXPECT_EQ(before[i].value, after[i].value);
    }
  }
}

TEST(Settings, FloatsKeepTheirBits) {
  for (const float value : {0.1f, 1.0f / 3.0f, 1e-7f, 0.999999940395f, 1.17549435e-38f}) {
    Settings settings, again;
    settings.specular.gpu.maxRoughness = value;
    settingsFromJson(again, settingsToJson(settings));
    EXPECT_EQ(std::bit_cast<uint32_t>(again.specular.gpu.maxRoughness), std::bit_cast<uint32_t>(value));
  }
}

TEST(Settings, JsonHoldsPlainDecimals) {
  const auto json = nlohmann::json::parse(settingsToJson(Settings{}));
  EXPECT_EQ(json.at("specular.max_roughness").dump(), "0.6");
  EXPECT_EQ(json.at("matrix.format"), "csr");
  EXPECT_EQ(json.at("matrix.jitter"), true);
  EXPECT_EQ(json.at("voxel.resolution"), 64);
}

TEST(Settings, RangeEndsAreAllowedAndBeyondIsNot) {
  for (const SettingInfo& info : settingInfos(Settings{})) {
    if (info.kind != "integer" && info.kind != "number") continue;
    SCOPED_TRACE(info.meta.name);
    Settings settings;
    const auto set = [&](double value) { applySetting(settings, fmt::format("{}={}", info.meta.name, value)); };
    EXPECT_NO_THROW(set(info.meta.min));
    EXPECT_NO_THROW(set(info.meta.max));
    const double beyond = info.kind == "integer" ? 1.0 : 0.01 * (info.meta.max - info.meta.min);
    const std::string above = usageError([&] { set(info.meta.max + beyond); });
    EXPECT_TRUE(contains(above, fmt::format("{}", info.meta.max))) << above;
    EXPECT_TRUE(contains(above, info.meta.name)) << above;
    const std::string below = usageError([&] { set(info.meta.min - beyond); });
    EXPECT_TRUE(contains(below, info.meta.name)) << below;
  }
}

TEST(Settings, BadValuesAreRefusedAndChangeNothing) {
  Settings settings;
  const std::string before = settingsToJson(settings);
  for (const char* bad : {"solver.lambda=nan", "solver.lambda=inf", "matrix.rays=", "matrix.rays=12x",
                          "matrix.rays=1.5", "matrix.rays=-1", "matrix.rays=99999999999", "matrix.jitter=2",
                          "camera.pcf=2", "voxel.resolution", "=3", "", "matrix.hit_rule=0"})
    EXPECT_NE(usageError([&] { applySetting(settings, bad); }), "(no error)") << bad;
  EXPECT_EQ(settingsToJson(settings), before);
  EXPECT_TRUE(contains(usageError([&] { applySetting(settings, "camera.pcf=4"); }), "1 | 3 | 5 taps"));
}

TEST(Settings, UnknownNamesListNearMatches) {
  Settings settings;
  const auto message = [&](const char* text) { return usageError([&] { applySetting(settings, text); }); };
  EXPECT_TRUE(contains(message("voxel.resolutoin=64"), "did you mean voxel.resolution"));
  EXPECT_TRUE(contains(message("matrix.ray=64"), "did you mean matrix.rays"));
  EXPECT_TRUE(contains(message("rays=64"), "matrix.rays"));
  EXPECT_TRUE(contains(message("specular.method=compute"), "specular.mode"));
  EXPECT_TRUE(contains(message("matrix.format=padd"), "did you mean padded"));
  EXPECT_TRUE(contains(message("voxel.normals=octo16"), "did you mean oct16"));
  EXPECT_TRUE(contains(message("sample.filter=zzz"), "nearest | linear | blur"));
  EXPECT_TRUE(contains(usageError([&] { settingValue(settings, "solver.lamda"); }), "solver.lambda"));
}

TEST(Settings, JsonIsAllOrNothing) {
  Settings settings;
  const std::string before = settingsToJson(settings);
  for (const char* bad : {R"({"matrix.rays": 7, "matrix.rayz": 8})", R"({"matrix.rays": 7, "voxel.resolution": 1e9})",
                          R"({"matrix.rays": [7]})", R"({"matrix.rays": null})", "[]", "{", ""})
    EXPECT_NE(usageError([&] { settingsFromJson(settings, bad); }), "(no error)") << bad;
  EXPECT_EQ(settingsToJson(settings), before);
  settingsFromJson(settings, R"({"matrix.rays": 7})");
  EXPECT_EQ(settings.matrix.gpu.rays, 7u);
}

TEST(Settings, DifferenceIsTheFirstStageToRedo) {
  Settings a, b;
  EXPECT_EQ(difference(a, b), Redo::Nothing);
  b.camera.exposureEv = 2;
  EXPECT_EQ(difference(a, b), Redo::Nothing);
  b.specular.gpu.rays = 9;
  EXPECT_EQ(difference(a, b), Redo::Shade);
  b.solver.gpu.lambda = 0.5f;
  EXPECT_EQ(difference(a, b), Redo::Solve);
  b.matrix.gpu.seed = 1;
  EXPECT_EQ(difference(a, b), Redo::Matrix);
  b.voxel.facets = 1;
  EXPECT_EQ(difference(a, b), Redo::Voxels);
}

TEST(Presets, ThesisIsTable5OnEveryDevice) {
  for (const bool cpu : {false, true}) {
    Settings s = defaultSettings(cpu);
    applyPreset(s, "thesis", cpu);
    const auto is = [&](const char* name, const char* value) { EXPECT_EQ(settingValue(s, name), value) << name; };
    is("voxel.resolution", "256");
    is("matrix.rays", "384");
    is("voxel.normals", "axis26");
    is("voxel.method", "raster");
    is("voxel.facets", "1");
    is("field.method", "jfa");
    is("matrix.traversal", "dda");
    is("matrix.hit_rule", "thesis");
    is("matrix.format", "padded");
    is("solver.kernel", "tree");
    is("solver.lambda", "0.8");
    is("sample.filter", "blur");
    is("sample.premultiplied", "true");
    is("sample.gated", "false");
    is("specular.mode", "fragment");
    is("specular.rays", "2");
    is("scatter.edge_removal", "false");
    is("thesis.literal", "false");
  }
}

TEST(Presets, DefaultsFollowTheDeviceClass) {
  EXPECT_EQ(defaultSettings(true).voxel.resolution, 64u);
  EXPECT_EQ(defaultSettings(true).matrix.gpu.rays, 128u);
  EXPECT_EQ(defaultSettings(false).voxel.resolution, 256u);
  EXPECT_EQ(defaultSettings(false).matrix.gpu.rays, 384u);
}

TEST(Presets, SizesAreLoweredStepByStepToTheSmallestDefaults) {
  Settings s = defaultSettings(/*cpuDevice=*/false);
  std::vector<std::pair<uint32_t, uint32_t>> steps;
  while (lowerSizes(s)) steps.emplace_back(s.voxel.resolution, s.matrix.gpu.rays);
  EXPECT_EQ(steps, (std::vector<std::pair<uint32_t, uint32_t>>{
                       {256, 256}, {256, 128}, {192, 128}, {144, 128}, {108, 128}, {81, 128}, {64, 128}}));
  Settings cpu = defaultSettings(/*cpuDevice=*/true);
  EXPECT_FALSE(lowerSizes(cpu));
}

TEST(Presets, EachIsTheSameWhateverCameBeforeAndKeepsTheSeed) {
  for (const std::string& name : presetNames()) {
    Settings direct = defaultSettings(true), detour = defaultSettings(true);
    direct.matrix.gpu.seed = detour.matrix.gpu.seed = 42;
    applyPreset(direct, name, true);
    for (const std::string& other : presetNames()) applyPreset(detour, other, true);
    applyPreset(detour, name, true);
    EXPECT_EQ(settingsToJson(direct), settingsToJson(detour)) << name;
    EXPECT_EQ(direct.matrix.gpu.seed, 42u);
    for (const SettingInfo& info : settingInfos(direct))  // a preset stays within the ranges
      EXPECT_NO_THROW(applySetting(direct, fmt::format("{}={}", info.meta.name, info.value)));
  }
  Settings balanced = defaultSettings(true);
  applyPreset(balanced, "balanced", true);
  EXPECT_EQ(difference(balanced, defaultSettings(true)), Redo::Nothing);
  EXPECT_TRUE(contains(usageError([] {
                         Settings s;
                         applyPreset(s, "thesys");
                       }),
                       "did you mean thesis"));
}

TEST(NearMatch, KnownDistances) {
  EXPECT_EQ(editDistance("", ""), 0u);
  EXPECT_EQ(editDistance("abc", ""), 3u);
  EXPECT_EQ(editDistance("kitten", "sitting"), 3u);
  EXPECT_EQ(editDistance("ab", "ba"), 1u);  // one swap
  EXPECT_EQ(editDistance("lit", "list"), 1u);
  EXPECT_EQ(nearMatches("rendr", {"view", "render", "bench"}), std::vector<std::string>{"render"});
  EXPECT_TRUE(nearMatches("qqqqqq", {"view", "render", "bench"}).empty());
}

}  // namespace
}  // namespace irad
