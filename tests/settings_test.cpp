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
#include "renderer/base/error.h"
#include "renderer/base/near_match.h"
#include "tests/setting_values.h"

namespace irad::settings_suite {
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

bool isNumeric(const Setting& setting) {
  return setting.kind == SettingKind::integer || setting.kind == SettingKind::number;
}

TEST(Settings, NamesAreUniqueGroupedAndDocumented) {
  std::set<std::string> names;
  for (const Setting& setting : settingTable()) {
    EXPECT_TRUE(names.insert(setting.name).second) << setting.name;
    EXPECT_TRUE(contains(setting.name, ".")) << setting.name;
    EXPECT_GT(std::string(setting.help).size(), 10u) << setting.name;
    if (isNumeric(setting)) {
      EXPECT_LT(setting.range.min, setting.range.max) << setting.name;
    }
  }
  EXPECT_GE(names.size(), 36u);
}

// Two rows of one member would be one setting with two names.
TEST(Settings, EveryRowHasAMemberOfItsOwn) {
  const Settings before;
  for (const Setting& setting : settingTable()) {
    Settings after;
    setting.set(after, test::anotherValue(setting, before));
    EXPECT_NE(before, after) << setting.name;
    for (const Setting& other : settingTable())
      EXPECT_EQ(other.get(before) == other.get(after), other.name != setting.name)
          << setting.name << ", " << other.name;
    setting.set(after, setting.get(before));
    EXPECT_EQ(before, after) << setting.name;
  }
}

TEST(Settings, DefaultsLieInTheirRanges) {
  for (const bool cpu : {false, true}) {
    Settings settings = defaultSettings(cpu);
    for (const Setting& setting : settingTable())
      EXPECT_NO_THROW(applySetting(settings, fmt::format("{}={}", setting.name, setting.text(settings))))
          << setting.name;
    EXPECT_EQ(settings, defaultSettings(cpu));
  }
}

TEST(Settings, EverySettingRoundTripsThroughTextAndJson) {
  const Settings before;
  for (const Setting& setting : settingTable()) {
    SCOPED_TRACE(setting.name);
    Settings changed;
    setting.set(changed, test::anotherValue(setting, before));
    EXPECT_NE(setting.text(changed), setting.text(before));
    Settings named;
    applySetting(named, fmt::format("{}={}", setting.name, setting.text(changed)));
    EXPECT_EQ(named, changed);

    Settings again;
    settingsFromJson(again, settingsToJson(changed));
    EXPECT_EQ(again, changed);  // nothing else moved
    EXPECT_EQ(settingsToJson(again), settingsToJson(changed));
    EXPECT_EQ(setting.text(again), setting.text(changed));
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
  for (const Setting& setting : settingTable()) {
    if (!isNumeric(setting)) continue;
    SCOPED_TRACE(setting.name);
    const SettingRange& range = setting.range;
    Settings settings;
    const auto set = [&](double value) { applySetting(settings, fmt::format("{}={}", setting.name, value)); };
    EXPECT_NO_THROW(set(range.min));
    EXPECT_NO_THROW(set(range.max));
    const double beyond = setting.kind == SettingKind::integer ? 1.0 : 0.01 * (range.max - range.min);
    const std::string above = usageError([&] { set(range.max + beyond); });
    EXPECT_TRUE(contains(above, fmt::format("{}", range.max))) << above;
    EXPECT_TRUE(contains(above, setting.name)) << above;
    const std::string below = usageError([&] { set(range.min - beyond); });
    EXPECT_TRUE(contains(below, setting.name)) << below;
  }
}

TEST(Settings, BadValuesAreRefusedAndChangeNothing) {
  Settings settings;
  const Settings before = settings;
  for (const char* bad : {"solver.lambda=nan", "solver.lambda=inf", "matrix.rays=", "matrix.rays=12x",
                          "matrix.rays=1.5", "matrix.rays=-1", "matrix.rays=99999999999", "matrix.jitter=2",
                          "camera.pcf=2", "voxel.resolution", "=3", "", "matrix.hit_rule=0"})
    EXPECT_NE(usageError([&] { applySetting(settings, bad); }), "(no error)") << bad;
  EXPECT_EQ(settings, before);
  EXPECT_TRUE(contains(usageError([&] { applySetting(settings, "camera.pcf=4"); }), "1 | 3 | 5 taps"));
}

TEST(Settings, AutoIsAnExposureToo) {
  Settings settings;
  applySetting(settings, "camera.exposure=1.5");
  applySetting(settings, "camera.exposure=auto");
  EXPECT_TRUE(settings.camera.autoExposure);
  EXPECT_EQ(settings.camera.exposureEv, 1.5f) << "which comes on top";
  Settings read;
  settingsFromJson(read, R"({"camera.exposure": "auto"})");
  EXPECT_TRUE(read.camera.autoExposure);
  EXPECT_THROW(applySetting(settings, "camera.exposure=automatic"), UsageError);
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
  EXPECT_TRUE(contains(usageError([&] { findSetting("solver.lamda"); }), "solver.lambda"));
}

TEST(Settings, JsonIsAllOrNothing) {
  Settings settings;
  const Settings before = settings;
  for (const char* bad : {R"({"matrix.rays": 7, "matrix.rayz": 8})", R"({"matrix.rays": 7, "voxel.resolution": 1e9})",
                          R"({"matrix.rays": [7]})", R"({"matrix.rays": null})", "[]", "{", ""})
    EXPECT_NE(usageError([&] { settingsFromJson(settings, bad); }), "(no error)") << bad;
  EXPECT_EQ(settings, before);
  settingsFromJson(settings, R"({"matrix.rays": 7})");
  EXPECT_EQ(settings.matrix.gpu.rays, 7u);
}

TEST(Presets, ThesisIsTable5OnEveryDevice) {
  for (const bool cpu : {false, true}) {
    Settings s = defaultSettings(cpu);
    applyPreset(s, "thesis", cpu);
    const auto is = [&](const char* name, const char* value) { EXPECT_EQ(findSetting(name).text(s), value) << name; };
    is("voxel.resolution", "256");
    is("matrix.rays", "384");
    is("voxel.normals", "axis26");
    is("voxel.method", "raster");
    is("field.method", "jfa");
    is("matrix.traversal", "dda");
    is("matrix.hit_rule", "thesis");
    is("matrix.format", "padded");
    is("solver.kernel", "tree");
    is("solver.lambda", "0.8");
    is("sample.filter", "blur");
    is("sample.premultiplied", "true");
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
    EXPECT_EQ(direct, detour) << name;
    EXPECT_EQ(direct.matrix.gpu.seed, 42u);
    for (const Setting& setting : settingTable())  // a preset stays within the ranges
      EXPECT_NO_THROW(applySetting(direct, fmt::format("{}={}", setting.name, setting.text(direct))));
  }
  Settings balanced = defaultSettings(true);
  applyPreset(balanced, "balanced", true);
  EXPECT_EQ(balanced, defaultSettings(true));
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
}  // namespace irad::settings_suite
