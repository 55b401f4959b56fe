// Lights edited while a scene is open: the picture is that of a scene with those lights, only the relight runs, and a
// failure leaves the old ones. The sidecar that keeps them: there and back, refusals, what the subcommands make of it.
#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <set>
#include <stdexcept>
#include <utility>

#include "gi/check/check.h"
#include "gi/check/scenes.h"
#include "gi/pipeline.h"
#include "gi/plan.h"
#include "gi/watch.h"
#include "renderer/base/error.h"
#include "renderer/scene/light_json.h"
#include "renderer/scene/sidecar.h"
#include "renderer/shadow.h"
#include "renderer/targets.h"
#include "tests/scene_files.h"
#include "tests/virtual_screen.h"

namespace irad::test::lights_suite {
namespace {

namespace fs = std::filesystem;
using Pixels = std::vector<std::byte>;

Settings small() {
  Settings s = defaultSettings(/*cpuDevice=*/true);
  s.voxel.resolution = 16;
  s.matrix.gpu.rays = 32;
  s.light.shadowResolution = 64;
  s.specular.mode = SpecularMode::off;
  return s;
}

/// One of each type; no two share a value.
std::vector<Light> threeLights() {
  return {{.name = "sky",
           .direction = glm::normalize(glm::vec3(-0.3f, -0.5f, -1.0f)),
           .color = {1.0f, 0.9f, 0.8f},
           .intensity = 2.5f},
          {.name = "bulb", .type = LightType::Point, .position = {0.2, 0.1, 0.3}, .intensity = 0.7f, .range = 3.0f},
          {.name = "stage",
           .type = LightType::Spot,
           .position = {-0.3, 0.4, 0.9},
           .direction = glm::normalize(glm::vec3(0.2f, -0.7f, -0.9f)),
           .color = {0.2f, 0.5f, 1.0f},
           .intensity = 3.0f,
           .innerCos = 0.95f,
           .outerCos = 0.8f}};
}

/// A white room without lamps: with no light it is dark.
Scene room(std::vector<Light> lights) {
  SceneBuilder b = stillLife(/*light=*/0.0f);
  Scene scene = b.finish("room");
  scene.lights = std::move(lights);
  return scene;
}

Pixels draw(Context& context, Pipeline& pipeline, View view) {
  Targets targets(context, {32, 24});
  Frame frame = context.begin();
  pipeline.render(frame, pipeline.scene().cameras.at(0), view, targets);
  frame.submitAndWait();
  return download(context, targets.linear);
}

/// The stages of which something was timed.
std::set<std::string> stages(const Timings& timings) {
  std::set<std::string> names;
  for (const Timings::Row& row : timings.rows()) names.insert(row.stage);
  return names;
}

class Lights : public GpuTest {
 protected:
  Timings& timings() { return gpu().timings; }
  /// The pictures of a scene that was loaded with these lights.
  Pixels of(std::vector<Light> lights, View view) {
    Pipeline pipeline(context(), room(std::move(lights)), small());
    pipeline.prepare();
    return draw(context(), pipeline, view);
  }
  static Light lamp(float candela = 1.0f) {
    return {.name = "lamp", .type = LightType::Point, .position = {0, 0, 0.5}, .intensity = candela};
  }
};

TEST_F(Lights, EditedOnesGiveThePictureOfASceneWithThem) {
  Pipeline pipeline(context(), room({lamp()}), small());
  pipeline.prepare();
  // More lights, fewer, others, none: direct light is equal to the bit.
  for (const std::vector<Light>& lights :
       {threeLights(), {threeLights()[2]}, {lamp(2.0f), threeLights()[0]}, std::vector<Light>{}}) {
    pipeline.setLights(lights);
    EXPECT_FALSE(pipeline.asleep());
    pipeline.prepare();
    EXPECT_TRUE(pipeline.asleep());
    EXPECT_EQ(pipeline.scene().lights, lights);
    EXPECT_TRUE(draw(context(), pipeline, VIEW_DIRECT) == of(lights, VIEW_DIRECT)) << lights.size() << " lights";
  }
  // From the dark the solver begins where a new scene's does: all light is equal to the bit.
  pipeline.setLights(threeLights());
  pipeline.prepare();
  const Pixels lit = draw(context(), pipeline, VIEW_LIT);
  EXPECT_TRUE(lit == of(threeLights(), VIEW_LIT));
  EXPECT_FALSE(lit == of({lamp()}, VIEW_LIT));
}

TEST_F(Lights, AnEditRunsTheRelightAlone) {
  Pipeline pipeline(context(), room({lamp()}), small());
  pipeline.prepare();
  timings().reset();
  std::vector<Light> lights = threeLights();
  lights.push_back(lamp());
  pipeline.setLights(lights);
  pipeline.prepare();
  EXPECT_EQ(stages(timings()),
            (std::set<std::string>{"RE Shadow", "GI Gather", "GI Solve", "GI Solve Energy", "GI Scatter", "Readback"}));
  for (const Timings::Row& row : timings().rows()) EXPECT_NE(row.kind, WorkKind::Setup) << row.stage;
  EXPECT_EQ(pipeline.shadows().flat.desc.layers, 2u);
  EXPECT_EQ(pipeline.shadows().cubes.desc.layers, 12u);
}

/// Off they are as if they were not there: no shadow map, no pass, the same bits; and editing one redoes nothing.
TEST_F(Lights, OnesThatAreOffCostNothing) {
  std::vector<Light> lights = threeLights();
  for (size_t off : {0u, 1u, 2u}) {
    std::vector<Light> some = lights, without = lights;
    some[off].on = false;
    without.erase(without.begin() + static_cast<ptrdiff_t>(off));
    EXPECT_TRUE(of(some, VIEW_DIRECT) == of(without, VIEW_DIRECT)) << lights[off].name;
    EXPECT_FALSE(of(some, VIEW_DIRECT) == of(lights, VIEW_DIRECT)) << lights[off].name;
  }
  for (Light& light : lights) light.on = light.type == LightType::Sun;
  Pipeline pipeline(context(), room(lights), small());
  pipeline.prepare();
  EXPECT_EQ(pipeline.shadows().flat.desc.layers, 1u) << "the sun's alone";
  EXPECT_FALSE(pipeline.shadows().cubes);
  EXPECT_TRUE(pipeline.plan().off(Effect::point));
  EXPECT_TRUE(pipeline.plan().off(Effect::spot));
  lights[1].position.x += 0.2, lights[1].intensity = 9, lights[2].outerCos = 0.5f, lights[2].color = glm::vec3(1);
  pipeline.setLights(lights);
  EXPECT_TRUE(pipeline.asleep()) << "an edit of one that is off";
  lights[1].on = true;
  pipeline.setLights(lights);
  EXPECT_FALSE(pipeline.asleep());
}

TEST_F(Lights, OnesOutOfRangeAreRefusedByNameAndTheOldStay) {
  Pipeline pipeline(context(), room({lamp()}), small());
  pipeline.prepare();
  const Pixels before = draw(context(), pipeline, VIEW_LIT);
  struct Damage {
    const char* said;
    std::function<void(Light&)> change;
  };
  for (const Damage& damage :
       std::vector<Damage>{{"its intensity -1 ", [](Light& l) { l.intensity = -1; }},
                           {"its intensity nan ", [](Light& l) { l.intensity = NAN; }},
                           {"its color (1, 2e+12, 1) ", [](Light& l) { l.color.y = 2e12f; }},
                           {"its position (0, 1e+16, 0.5) ", [](Light& l) { l.position.y = 1e16; }},
                           {"its direction (0, 0, 0) ", [](Light& l) { l.direction = glm::vec3(0); }},
                           {"its range -2 ", [](Light& l) { l.range = -2; }},
                           {"its cone's cosines are 0.5 inside and 0.6 outside",
                            [](Light& l) { l.innerCos = 0.5f, l.outerCos = 0.6f; }}}) {
    std::vector<Light> lights{lamp(), lamp()};
    lights[1].name = "bad";
    damage.change(lights[1]);
    try {
      pipeline.setLights(lights);
      ADD_FAILURE() << damage.said << "was accepted";
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find(fmt::format("light \"bad\": {}", damage.said)), std::string::npos)
          << error.what();
    }
    ASSERT_TRUE(pipeline.asleep());
  }
  EXPECT_EQ(pipeline.scene().lights, std::vector<Light>{lamp()});
  EXPECT_TRUE(draw(context(), pipeline, VIEW_LIT) == before);
}

/// Of more lights than a device with few layers can draw maps of, the weakest cast no shadow, and are named.
TEST_F(Lights, WithoutLayersForAllTheStrongestCastShadows) {
  struct FewLayers {
    uint32_t& layers = gpu().device->limits.maxImageArrayLayers;
    uint32_t before = std::exchange(layers, 13);
    ~FewLayers() { layers = before; }
  } few;
  std::vector<Light> lights(4, lamp());
  for (size_t i = 0; i < lights.size(); ++i) {
    lights[i].name = fmt::format("lamp {}", i);
    lights[i].position.x += 0.05 * static_cast<double>(i);
  }
  lights[1].intensity *= 0.5f;
  lights[2].intensity *= 0.25f;
  Pipeline pipeline(context(), room(lights), small());
  pipeline.prepare();
  EXPECT_EQ(pipeline.lightsWithoutShadow(), (std::vector<uint32_t>{1, 2}));
  const auto says = [&](const std::string& text) {
    const std::vector<Finding> findings = pipeline.findings();
    return std::ranges::any_of(findings, [&](const Finding& f) { return f.text.starts_with(text); });
  };
  EXPECT_TRUE(says("2 of 4 lights cast no shadow, and shine through walls: lamp 1, lamp 2. "));
  const Pixels two = draw(context(), pipeline, VIEW_DIRECT);

  // Another one is weaker now: its light comes through, the other's no more.
  std::swap(lights[0].intensity, lights[1].intensity);
  pipeline.setLights(lights);
  pipeline.prepare();
  EXPECT_EQ(pipeline.lightsWithoutShadow(), (std::vector<uint32_t>{0, 2}));
  EXPECT_FALSE(draw(context(), pipeline, VIEW_DIRECT) == two);

  // As many as there is room for: as on any device.
  lights.resize(2);
  pipeline.setLights(lights);
  pipeline.prepare();
  EXPECT_TRUE(pipeline.lightsWithoutShadow().empty());
  const Pixels drawn = draw(context(), pipeline, VIEW_DIRECT);
  few.layers = few.before;
  EXPECT_TRUE(drawn == of(lights, VIEW_DIRECT));
}

TEST_F(Lights, WithoutMemoryForAnyOfTheirResourcesTheOldStay) {
  Pipeline pipeline(context(), room({lamp()}), small());
  pipeline.prepare();
  const Pixels before = draw(context(), pipeline, VIEW_LIT);
  DeviceOptions& options = gpu().device->options;
  uint64_t n = 1;
  for (;; ++n) {
    options.failResource = gpu().device->counters.resources() + n;
    std::string message;
    try {
      pipeline.setLights(threeLights());
    } catch (const DeviceError& error) {
      message = error.what();
    }
    options.failResource = 0;
    if (message.empty()) break;
    EXPECT_NE(message.find("out of memory"), std::string::npos) << message;
    ASSERT_TRUE(pipeline.asleep()) << "resource " << n << ": " << message;
    ASSERT_TRUE(draw(context(), pipeline, VIEW_LIT) == before) << "after resource " << n << ": " << message;
  }
  EXPECT_GE(n, 6u);  // two maps, projections, lights, record
  pipeline.prepare();
  EXPECT_TRUE(draw(context(), pipeline, VIEW_DIRECT) == of(threeLights(), VIEW_DIRECT));
}

// ---- JSON and the sidecar -------------------------------------------------------------------------------------------

Camera bookmark(const std::string& name) {
  Camera camera;
  camera.name = name;
  camera.position = {0.1, 1.0 / 3.0, 1e6 + 0.7};
  camera.orientation = glm::normalize(glm::quat(0.9f, 0.1f, -0.3f, 0.2f));
  camera.yfov = 0.7f;
  return camera;
}

TEST(LightJson, KeepsEveryBit) {
  std::vector<Light> lights = threeLights();
  lights[1].position = {1.0 / 3.0, -1e6 - 0.1, 1e-9};
  lights[1].on = false;
  for (float degrees = 0.25f; degrees < 180.0f; degrees += 0.25f) {
    Light spot = lights[2];
    spot.outerCos = std::cos(degrees * std::numbers::pi_v<float> / 180.0f);
    spot.innerCos = std::cos(degrees * std::numbers::pi_v<float> / 270.0f);
    lights.push_back(spot);
  }
  // A point's direction and cone mean nothing and are not kept.
  const std::vector<Light> back = lightsFromJson(lightsToJson(lights));
  ASSERT_EQ(back.size(), lights.size());
  for (size_t i = 0; i < lights.size(); ++i) EXPECT_EQ(back[i], lights[i]) << i;
}

TEST(LightKinds, AreFoundByTypeNameAndGltfType) {
  ASSERT_EQ(lightKinds().size(), LIGHT_KINDS);
  for (const LightKind& kind : lightKinds()) {
    EXPECT_EQ(&lightKind(kind.type), &kind) << kind.name;
    EXPECT_EQ(findLightKind(kind.name), &kind);
    EXPECT_EQ(findGltfLightKind(kind.gltf), &kind);
    // What shaders go by says the same.
    const auto number = static_cast<uint32_t>(kind.type);
    for (const uint32_t trait : {LIGHT_DISTANT, LIGHT_DIRECTION, LIGHT_RANGE, LIGHT_CONE})
      EXPECT_EQ(lightHas(number, trait), kind.has(trait)) << kind.name << ", " << trait;
    EXPECT_EQ(lightUsesCube(number, /*outerCos=*/0.9f), kind.map == LIGHT_MAP_CUBE) << kind.name;
    EXPECT_EQ(lightUsesCube(number, /*outerCos=*/0.1f), kind.map != LIGHT_MAP_PARALLEL) << kind.name;
  }
  EXPECT_EQ(findLightKind("sun")->type, LightType::Sun);
  EXPECT_EQ(findGltfLightKind("directional")->type, LightType::Sun);
  EXPECT_EQ(findLightKind("directional"), nullptr);
  EXPECT_EQ(findGltfLightKind("sun"), nullptr);
}

TEST(LightKinds, ATypeThatNoneHasIsRefused) {
  const auto wrong = static_cast<LightType>(LIGHT_KINDS);
  EXPECT_FALSE(isLightKind(wrong));
  EXPECT_DEATH((void)lightKind(wrong), "LIGHT_KINDS \\(3 vs 3\\)");
  LightKinds kinds;
  EXPECT_THROW(kinds[wrong] = true, std::out_of_range);
  EXPECT_FALSE(lightHas(LIGHT_KINDS, ~0u));
  EXPECT_FALSE(lightUsesCube(LIGHT_KINDS, 0));
  EXPECT_EQ(unsound(Light{.name = "lamp", .type = wrong}), "light \"lamp\": its type 3 is no kind of light");
}

TEST(LightJson, WhatIsAbsentIsAsInTheGltfExtension) {
  const std::vector<Light> lights = lightsFromJson(
      R"([{"type": "spot", "position": [1, 2, 3], "direction": [0, -3, 4]}, {"type": "sun", "direction": [0, 0, 1]}])");
  ASSERT_EQ(lights.size(), 2u);
  EXPECT_EQ(lights[0].direction, glm::vec3(0, -0.6f, 0.8f));
  EXPECT_EQ(lights[0].intensity, 1.0f);
  EXPECT_EQ(lights[0].range, 0.0f);
  EXPECT_EQ(lights[0].innerCos, 1.0f);
  EXPECT_FLOAT_EQ(lights[0].outerCos, std::cos(std::numbers::pi_v<float> / 4));
  EXPECT_EQ(lights[1].position, glm::dvec3(0));
}

TEST(LightJson, RefusalsNameLightFieldAndValue) {
  const std::vector<std::pair<const char*, const char*>> cases{
      {R"({})", "L: expected an array"},
      {R"([5])", "L[0]: expected a JSON object"},
      {R"([{"type": "sun", "direction": [0, 0, 1]}, {"type": "lamp"}])",
       "L[1]: type: unknown 'lamp' (one of: sun, point, spot)"},
      {R"([{"type": "pont"}])", "(did you mean point?)"},
      {R"([{"name": "x"}])", "L[0]: type is missing"},
      {R"([{"type": "point"}])", "L[0]: position is missing"},
      {R"([{"type": "spot", "position": [0, 0, 0]}])", "L[0]: direction is missing"},
      {R"([{"type": "sun", "direction": [0, 0, 0]}])", "L[0]: direction: has no length"},
      {R"([{"type": "sun", "direction": [0, 1]}])", "L[0]: direction: expected 3 numbers, not [0,1]"},
      {R"([{"type": "sun", "direction": [0, 1, 0], "range": 2}])", "L[0]: range: a sun has none"},
      {R"([{"type": "point", "position": [0, 1, 0], "outerConeAngle": 1}])", "L[0]: outerConeAngle: a point has none"},
      {R"([{"type": "point", "position": [0, 1e16, 0]}])", "L[0]: position: expected a number up to 1e+15, not 1e+16"},
      {R"([{"type": "point", "position": [0, 1, 0], "range": 0}])", "L[0]: range: must be at least"},
      {R"([{"type": "point", "position": [0, 1, 0], "name": "a", "intensity": -2}])",
       "L[0]: light \"a\": its intensity -2 is not from 0 to 1e+12"},
      {R"([{"type": "point", "position": [0, 1, 0], "colour": [1, 1, 1]}])",
       "unknown field 'colour' (did you mean color?)"},
      {R"([{"type": "point", "position": [0, 1, 0], "on": 0}])", "L[0]: on: expected true or false, not 0"},
      {R"([{"type": "point", "position": [0, 1, 0], "angle": 1}])", "L[0]: angle: a point has none"},
      {R"([{"type": "sun", "direction": [0, 1, 0], "radius": 1}])", "L[0]: radius: a sun has none"},
      {R"([{"type": "point", "position": [0, 1, 0], "name": "a", "radius": -0.5}])",
       "L[0]: light \"a\": its radius -0.5 is not from 0 to 1e+15 m"},
      {R"([{"type": "sun", "direction": [0, 1, 0], "name": "a", "angle": 91}])",
       "L[0]: light \"a\": its angle 91 is not from 0 to 90 degrees"},
      {R"([{"type": "spot", "position": [0, 0, 0], "direction": [0, 1, 0], "outerConeAngle": 4}])",
       "L[0]: outerConeAngle: expected 0 to pi (radians), not 4"},
      {R"([{"type": "spot", "position": [0, 0, 0], "direction": [0, 1, 0], "innerConeAngle": 1}])",
       "its cone's cosines"}};
  for (const auto& [text, said] : cases) try {
      lightsFromJson(text, "L");
      ADD_FAILURE() << text << " was accepted";
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
    }
}

/// A triangle's scene file and its sidecar in a folder of their own.
struct SidecarTest : ::testing::Test {
  TemporaryFolder folder;
  fs::path scene = triangleFile().write(folder.path), sidecar = sidecarPath(scene);
  Scene load() { return loadScene(scene, {.sidecar = true}); }
};

TEST_F(SidecarTest, LiesBesideTheSceneAndComesBackToTheBit) {
  EXPECT_EQ(sidecar, folder.path / "scene.gltf.irad.json");
  const Scene own = load();
  EXPECT_TRUE(own.sidecar.empty());
  const Sidecar written{
      .lights = threeLights(), .bookmarks = {bookmark("door"), bookmark("window \"2\"")}, .sceneSha256 = own.sha256};
  writeSidecar(sidecar, written);
  EXPECT_EQ(readSidecar(sidecar), written);

  const Scene s = load();
  EXPECT_EQ(s.sidecar, sidecar);
  EXPECT_EQ(s.lights, threeLights());
  EXPECT_EQ(s.fileLights, own.lights);
  EXPECT_EQ(s.bookmarks, written.bookmarks);
  EXPECT_EQ(s.cameras, own.cameras);
  EXPECT_EQ(allCameras(s).size(), own.cameras.size() + 2);
  EXPECT_EQ(sidecarNote(s), "lights and cameras of scene.gltf.irad.json");
  // The default sun is no longer there, nor is its warning.
  EXPECT_TRUE(own.defaultLight && warns(own, "default sun"));
  EXPECT_FALSE(s.defaultLight || warns(s, "default sun"));
  EXPECT_EQ(loadScene(scene).lights, own.lights) << "taken without being asked for";
  // The command line comes before the sidecar.
  EXPECT_EQ(loadScene(scene, {.sidecar = true, .lights = std::vector<Light>{}}).lights.size(), 0u);
}

TEST_F(SidecarTest, WithoutLightsTheScenesOwnStay) {
  writeSidecar(sidecar, {.bookmarks = {bookmark("door")}});
  const Scene s = load();
  EXPECT_TRUE(s.defaultLight);
  EXPECT_EQ(s.lights, s.fileLights);
  EXPECT_EQ(sidecarNote(s), "cameras of scene.gltf.irad.json");
  EXPECT_FALSE(warns(s, "has changed"));
  writeSidecar(sidecar, {.lights = std::vector<Light>{}, .sceneSha256 = std::string(64, '0')});
  const Scene dark = load();
  EXPECT_TRUE(dark.lights.empty());
  EXPECT_TRUE(warns(dark, "scene.gltf has changed since scene.gltf.irad.json was saved"));
}

TEST_F(SidecarTest, RefusalsNameFileObjectAndValue) {
  const std::string camera = R"({"name": "a", "position": [0, 0, 0], "target": [0, 0, 1]})";
  const std::vector<std::pair<std::string, const char*>> cases{
      {"", "not JSON"},
      {"[]", "format is missing"},
      {"{}", "format is missing"},
      {R"({"format": "1"})", "format: expected a whole number from 1, not \"1\""},
      {R"({"format": 2, "weather": 1})", "is of format 2, written by a newer program; this one reads up to format 1"},
      {R"({"format": 1, "light": []})", "unknown field 'light' (did you mean lights"},
      {R"({"format": 1, "lights": [{"type": "point"}]})", "lights[0]: position is missing"},
      {R"({"format": 1, "cameras": {}})", "cameras: expected an array"},
      {R"({"format": 1, "cameras": [)" + camera + R"(, {"name": "b", "position": [0, 0]}]})",
       "cameras[1]: position: expected 3 numbers, not [0,0]"},
      {R"({"format": 1, "cameras": [)" + camera + "," + camera + "]}", "cameras[1]: name 'a': is taken"},
      {R"({"format": 1, "cameras": [{"position": [0, 0, 0], "target": [0, 0, 1]}]})",
       "cameras[0]: name '': a bookmark needs one"},
      {"{\"format\": 1, \"lights\": " + std::string(200, '['), "nested too deeply"}};
  for (const auto& [text, said] : cases) {
    std::ofstream(sidecar) << text;
    try {
      load();
      ADD_FAILURE() << text << " was accepted";
    } catch (const InputError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with(sidecar.string() + ": ")) << error.what();
      EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
    }
  }
}

TEST_F(SidecarTest, CheckScenesHaveNone) {
  const Scene s = openScene("check:furnace-box", {.sidecar = true, .lights = threeLights()});
  EXPECT_TRUE(s.sidecar.empty());
  EXPECT_EQ(s.lights, threeLights());
}

// ---- The program ----------------------------------------------------------------------------------------------------

class SidecarCli : public SidecarTest {
 protected:
  RunResult render(const std::string& out, std::vector<std::string> more) {
    std::vector<std::string> command{"render", "--out", (folder.path / out).string()};
    command.insert(command.end(), more.begin(), more.end());
    return runIrad(command);
  }
  std::vector<std::string> tiny(std::vector<std::string> more = {}) const {
    std::vector<std::string> all{scene.string(),
                                 "--size",
                                 "24x24",
                                 "--set",
                                 "voxel.resolution=8",
                                 "--set",
                                 "matrix.rays=16",
                                 "--set",
                                 "light.shadow_resolution=64",
                                 "--view",
                                 "lit"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  std::string picture(const std::string& out) const {
    for (const char* name : {"lit.exr", "lit.pfm"})
      if (fs::exists(folder.path / out / name)) return slurp(folder.path / out / name);
    return "";
  }
};

TEST_F(SidecarCli, IsSaidIgnoredOnRequestAndReplayedWhateverBecomesOfIt) {
  ASSERT_EQ(render("own", tiny()).status, 0);
  writeSidecar(sidecar, {.lights = threeLights(), .bookmarks = {bookmark("door")}});
  const RunResult lit = render("lit", tiny());
  ASSERT_EQ(lit.status, 0) << lit.err;
  EXPECT_NE(lit.err.find("lights and cameras of scene.gltf.irad.json"), std::string::npos) << lit.err;
  EXPECT_FALSE(picture("lit") == picture("own"));
  const RunResult without = render("without", tiny({"--no-sidecar"}));
  ASSERT_EQ(without.status, 0) << without.err;
  EXPECT_EQ(without.err.find("irad.json"), std::string::npos) << without.err;
  EXPECT_TRUE(picture("without") == picture("own"));
  EXPECT_EQ(render("door", tiny({"--camera", "door"})).status, 0);

  // A manifest brings its lights: the sidecar may have changed, broken or gone.
  const std::string manifest = (folder.path / "lit/manifest.json").string(),
                    own = (folder.path / "own/manifest.json").string();
  std::ofstream(sidecar) << "broken";
  for (const auto& [name, config] : {std::pair{"lit", manifest}, {"own", own}}) {
    const RunResult again = render("again", {"--config", config});
    ASSERT_EQ(again.status, 0) << again.err;
    EXPECT_TRUE(picture("again") == picture(name)) << name;
    EXPECT_EQ(slurp(folder.path / "again/manifest.json"), slurp(config));
    // So does the command line that it states.
    const std::string command = nlohmann::json::parse(slurp(config))["command"];
    const std::string shell = iradProgram() + command.substr(4) + " --out " + (folder.path / "shell").string();
    ASSERT_EQ(runProgram("/bin/sh", {"-c", shell}).status, 0) << shell;
    EXPECT_TRUE(picture("shell") == picture(name)) << name;
  }
  const RunResult refused = render("refused", tiny());
  EXPECT_EQ(refused.status, 3);
  EXPECT_NE(refused.err.find("scene.gltf.irad.json: not JSON"), std::string::npos) << refused.err;
  const RunResult slip = render("slip", tiny({"--lights", R"([{"type": "sun"}])"}));
  EXPECT_EQ(slip.status, 2);
  EXPECT_NE(slip.err.find("--lights[0]: direction is missing"), std::string::npos) << slip.err;
}

}  // namespace
}  // namespace irad::test::lights_suite
