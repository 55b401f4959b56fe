// The pipeline obeys the plan: what is not called for is neither recorded nor allocated, and appears with what calls
// for it, with the next picture, with its passes, memory and shader code; it goes with it, to the last byte. Where the
// scene does not call for an effect, forced on it gives the same bits.
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <span>

#include "renderer/base/csv.h"
#include "renderer/shadow.h"
#include "tests/effects_fixture.h"

namespace irad::test::effects_suite {
namespace {

/// The first is what thresholds are judged by.
constexpr View kViews[] = {VIEW_LIT,      VIEW_IRRADIANCE, VIEW_DIRECT_IRRADIANCE,
                           VIEW_INDIRECT, VIEW_SPECULAR,   VIEW_NORMAL};

const Scene kEmpty = room(/*emits=*/false), kGlossy = glossy(kEmpty), kLamp = room(/*emits=*/true, {lamp(0.3)}),
            kTextured = room(/*emits=*/true, {spot()}, /*textured=*/true),
            kEven = furnaceBox(0.5f);  // H is the same everywhere but for what lights add to it

/// The left wall is a pane.
Scene glazed(Scene scene) {
  scene.materials[1].alpha = AlphaMode::Blend;
  scene.materials[1].baseColor.a = 0.4f;
  return scene;
}
const Scene kGlazed = glazed(room(/*emits=*/true, {spot()}));
/// Or one that lets colours through.
Scene stained(Scene scene) {
  scene.materials[1].baseColor = glm::vec4(0.9f, 0.5f, 0.2f, 1);
  scene.materials[1].transmission = 0.8f;
  return scene;
}
const Scene kStained = stained(room(/*emits=*/true, {spot()}));

Scene litRoom(std::vector<Light> lights = {lamp(0)}) {
  Scene scene = furnishedRoom();
  scene.lights = std::move(lights);
  return scene;
}

/// How one effect is called for, and what it brings along. Among them are lights of each kind alone, a spot with one
/// map and with six, and of any two kinds.
struct Row {
  Effect effect;
  const Scene& scene;
  Edit off, on;           ///< the scene no longer calls for the effect; it does
  std::string terms;      ///< of EffectsTest::expect(), for the effect alone
  const char* kind = "";  ///< tells rows of one effect apart
};
using E = Effect;
std::string forwardWith(uint32_t constant) {
  return fmt::format("forward with {}.", constant);
}
const Row kRows[] = {
    {E::emission, kLamp, setting("effects.emission=off"), setting("effects.emission=auto"),
     "GI Solve Emitters, has emitted share F M, " + forwardWith(FORWARD_EMISSION)},
    {E::emitterSampling, kLamp, setting("matrix.emitter_sampling=off"), setting("matrix.emitter_sampling=on"),
     "has emitters' correction, shader gi/sample_emitters"},
    {E::sun, kEmpty, lights({lamp(0.3)}), lights({lamp(0.3), sun()}),
     "has shadow maps, " + forwardWith(FORWARD_LIGHTS + LIGHT_SUN)},
    {E::point, kEmpty, lights({sun(), spot()}), lights({sun(), spot(), lamp(0.3)}),
     "has shadow cubes, " + forwardWith(FORWARD_LIGHTS + LIGHT_POINT)},
    {E::spot, kEmpty, lights({lamp(0.3)}), lights({lamp(0.3), spot(), spot(0.17f)}),
     "has shadow maps, " + forwardWith(FORWARD_LIGHTS + LIGHT_SPOT)},
    {E::matrix, kEmpty, lights({}), lights({lamp(0.3)}),
     "GI BuildMatrix, has indirect irradiance H, " + forwardWith(FORWARD_INDIRECT)},
    {E::specular, kGlossy, lights({}), lights({lamp(0.3)}),
     "RE Specular, has specular radiance, " + forwardWith(FORWARD_F0)},
    {E::field, kLamp, setting("matrix.traversal=dda"), setting("matrix.traversal=sdf"), "GI SDF, has chebyshev field"},
    {E::alphaTest, kTextured, setting("effects.alpha_test=off"), setting("effects.alpha_test=auto"),
     "shader forward/depth_masked.frag"},
    {E::glass, kGlazed, setting("effects.glass=off"), setting("effects.glass=auto"),
     "RE Glass, has layers of glass, shader forward/add_layer.comp, shader forward/depth_peeled.frag"},
    {E::glass, kStained, setting("effects.glass=off"), setting("effects.glass=auto"),
     "RE Glass, has layers of glass, has what shows behind panes, shader forward/add_tinted_layer.comp, "
     "shader forward/depth_peeled.frag",
     "tinted"},
    {E::normalMap, kTextured, setting("effects.normal_map=off"), setting("effects.normal_map=auto"),
     forwardWith(FORWARD_NORMAL_MAP)},
    {E::blur, kEven, lights({}), lights({spot(0.17f)}), "has blurred H"},
};

class Effects : public EffectsTest {};
class EffectRows : public EffectsTest, public ::testing::WithParamInterface<size_t> {};

TEST_P(EffectRows, ComeWithinOneFrameAndGoWithTheirMemory) {
  const Row& row = kRows[GetParam()];
  const std::string name = effectInfo(row.effect).name, there = fmt::format("{} on, {}", name, row.terms),
                    absent = "-" + std::regex_replace(there, std::regex(", "), ", -");
  const auto bench = this->bench(row.scene);
  // From the dark, so that the light does not depend on what was there before.
  const auto afresh = [](const Edit& edit) { return [edit](Pipeline& p) { edit(p), p.darken(); }; };
  const Step off{afresh(row.off), absent, 'a'};
  const Step on{afresh(row.on), there, row.effect == E::field ? 'a' : 'b'};  // the field only saves time
  facts(bench->pipeline());                                                  // those of how it was opened
  walk(bench->pipeline(), {off, on, off, on});
  const uint64_t bytes = app::heldBytes(context());
  walk(bench->pipeline(), {off});
  EXPECT_TRUE(row.terms.find("has ") == std::string::npos || app::heldBytes(context()) < bytes);
  app::require(app::proveEach(name + " off", *bench, kViews));
  row.on(bench->pipeline());
  bench->prepare({});
  app::require(app::proveEach(name + " on", *bench, kViews));
}

INSTANTIATE_TEST_SUITE_P(Plan, EffectRows, ::testing::Range(size_t{0}, std::size(kRows)), [](const auto& info) {
  std::string name = effectInfo(kRows[info.param].effect).name;
  std::erase(name, '-');
  return name + kRows[info.param].kind;
});

/// The terms of the lit picture are weighted behind panes as it is, so that they add up to it, there too.
TEST_F(Effects, TermsOfTheLightAddUpBehindPanes) {
  constexpr View kTerms[] = {VIEW_LIT, VIEW_DIRECT, VIEW_INDIRECT, VIEW_SPECULAR};
  for (const Scene* of : {&kGlazed, &kStained}) {
    // From before the pane, which is the left wall, into the room.
    Scene scene = glossy(*of);
    scene.materials[1].doubleSided = true;
    Camera& camera = scene.cameras.at(0);
    camera.position = {-3, 0.8, 0.3};
    camera.orientation = glm::quatLookAt(glm::normalize(glm::vec3(3, -0.3f, -0.3f)), glm::vec3(0, 1, 0));
    const std::vector<glm::vec4> pixels = bench(scene)->picturesAsLit(kTerms);
    const size_t n = pixels.size() / std::size(kTerms);
    const std::span lit(pixels.data(), n), direct(&pixels[n], n), indirect(&pixels[2 * n], n),
        specular(&pixels[3 * n], n);
    double light = 0, byOthers = 0, apart = 0;
    for (size_t i = 0; i < lit.size(); ++i) {
      const glm::vec3 sum = glm::vec3(direct[i]) + glm::vec3(indirect[i]) + glm::vec3(specular[i]);
      light += lit[i].y, byOthers += indirect[i].y, apart += std::abs(double{sum.y} - lit[i].y);
    }
    EXPECT_GT(byOthers, 0.05 * light) << "nothing is seen behind the pane";
    EXPECT_LT(apart, 1e-5 * light);
  }
}

/// Lamps that are dragged about: what is there after the first place stays, and what is not does not come.
TEST_F(Effects, LightsThatMoveSwitchNothing) {
  /// By how much the blur would change the light at last.
  const auto drag = [&](const Scene& scene, float blurNoise, std::string terms, char picture,
                        std::initializer_list<Light> places) {
    Settings s = small();
    s.effects.blurNoise = blurNoise;
    const auto bench = this->bench(scene, s);
    std::vector<Step> steps;
    for (const Light& place : places) steps.push_back({lights({place}), terms, picture});
    walk(bench->pipeline(), steps);
    return bench->pipeline().traits().light.noise.value_or(0);
  };
  // Where its range ends at the room's wall. 16 voxels of 1/8: two of them wide is the trigger, four where it lets go.
  const auto atReach = [](double gap) {
    Light light = lamp(1 + gap);
    light.position.y = 0;
    light.range = 1;
    return light;
  };
  drag(kEmpty, 0.01f, "point on, has shadow cubes, has matrix", '.', {atReach(1.2), atReach(1.3), atReach(1.2)});
  drag(kEmpty, 0.01f, "point off, -has shadow cubes, -has matrix", '.', {atReach(2), atReach(1.3), atReach(2)});
  const auto places = {lamp(0.2), lamp(0.1), lamp(-0.2), lamp(0.3)};
  // Lights do not change F M, nor what was found of its samples.
  drag(kLamp, 0.01f, "emitter-sampling on, has emitters' correction", ' ', places);
  // The blur is watched, not tried: where it shows nothing it stays off. What it would change is the same number,
  // measured with its copies or without.
  const float with = drag(kLamp, 1e-4f, "blur on, has blurred H", ' ', places),
              without = drag(kLamp, 0.99f, "blur off, -has blurred H", ' ', places);
  EXPECT_GT(with, 0);
  EXPECT_EQ(with, without);
}

/// A light brings matrix, field and light in one prepare, keeps the matrix while it is turned down, and takes all of it
/// along.
TEST_F(Effects, WithoutLightThereIsNothingOfIt) {
  const std::string nothing =
      "-GI BuildMatrix, -GI SDF, -GI Gather, -GI Solve, -GI Scatter, matrix off, -has matrix, -has solver, -has field";
  const auto bench = this->bench(furnishedRoom());
  walk(bench->pipeline(), {{{}, "GI Voxelization, GI CompactList, " + nothing, '.'}});
  for (const ViewInfo& view : views()) draw(bench->pipeline(), view.view);  // those of what is not there too
  recorded();
  walk(bench->pipeline(),
       {{{}, nothing, '.'},
        {lights({lamp(0)}), "matrix on, has matrix, has solver, has field, GI SDF, GI BuildMatrix", 'a'},
        {{}, "RE Forward, -GI ", 'a'},  // a camera that moves
        {lights({lamp(0.1)}), "GI Gather, -GI Voxelization, -GI SDF, -GI CompactList, -GI BuildMatrix", 'b'},
        {lights({lamp(0, /*candela=*/0)}), "matrix asleep, has matrix, -has solver", '.'},
        {lights({lamp(0)}), "-GI BuildMatrix, GI Solve, GI Scatter", 'a'},  // from the dark, as before
        {lights({}), nothing, '.'}});
  walk(this->bench(litRoom())->pipeline(), {{{}, "", 'a'}});
}

TEST_F(Effects, LightsThatDoNotReachGetNoShadowMap) {
  Light far = lamp(100);
  far.range = 5;
  const auto bench = this->bench(litRoom({lamp(0), far}));
  EXPECT_EQ(bench->pipeline().shadows().cubes.desc.layers, 6u);
  walk(bench->pipeline(), {{lights({far}), "-has shadow cubes"}, {setting("effects.point=on"), "has shadow cubes"}});
}

TEST_F(Effects, TheFieldIsMadeByItsViewsAndByForceWithoutAnotherMatrix) {
  Settings dda = small();  // the room is too rough for specular rays
  dda.matrix.gpu.traversal = Traversal::dda;
  const Edit traceAnew = [](Pipeline& p) {  // through the field
    p.invalidate(Redo::Matrix);
    p.darken();
  };
  walk(bench(litRoom(), dda)->pipeline(), {{{}, "-has field", 'a'},
                                           {{}, "has field", 'b', VIEW_DISTANCE},
                                           {{}, "-has field", 'a'},
                                           {setting("effects.field=on"), "has field, -GI BuildMatrix", 'a'},
                                           {traceAnew, "has field, GI BuildMatrix", 'a'}});
}

TEST_F(Effects, RelightThatIsOffLeavesTheLight) {
  const View h = VIEW_IRRADIANCE;
  walk(bench(litRoom())->pipeline(), {{{}, "relight asleep", 'a', h},
                                      {setting("effects.relight=off"), "", 'a', h},
                                      {lights({lamp(0.3)}), "-GI Gather", 'a', h},
                                      {setting("effects.relight=auto"), "GI Gather", 'b', h},
                                      {setting("effects.relight=on"), "GI Gather", ' ', h}});
}

/// What the program says of small pictures.
std::string irad(std::vector<std::string> arguments) {
  for (const char* small : {"--size", "48x36", "--set", "voxel.resolution=16", "--set", "matrix.rays=16", "--set",
                            "light.shadow_resolution=64"})
    arguments.push_back(small);
  const RunResult run = runIrad(arguments);
  EXPECT_EQ(run.status, 0) << run.err;
  return run.out;
}

TEST(IradPlan, PrintsTheTableWithWhatEachEffectThatIsOffWouldTake) {
  const auto rows = nlohmann::json::parse(irad({"plan", "box", "--json", "--measure", "--frames", "1"}))["effects"];
  ASSERT_EQ(rows.size(), kEffects);
  EXPECT_EQ(rows[0]["effect"], "emission");
  EXPECT_EQ(rows[0]["state"], "on");
  size_t off = 0;
  for (const auto& row : rows) {
    const bool measured = row.contains("ms_not_spent");
    // Each of them can be on, but what settings leave out: the method that is not in use, writeback.mode = off.
    const bool canBeOn = row["effect"] != "brute-force" && row["effect"] != "writeback";
    EXPECT_EQ(measured, row["state"] == "off" && canBeOn) << row;
    for (const char* kind : {"rebuild", "relight", "frame"})
      EXPECT_TRUE(!measured || row["ms_not_spent"][kind].is_number()) << row;  // what is no number is written as null
    off += measured;
  }
  EXPECT_GT(off, 0u);
}

/// (What is compared and does not hold fails the command.)
TEST(IradPlan, ProvesEveryRowThatIsNotOn) {
  const std::string file = testing::TempDir() + "/proof.csv";
  irad({"plan", "check:lights-off", "check:plates", "--prove", "--frames", "2", "--csv", file});
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> columns = csvFields(line);
  std::map<std::string, std::map<std::string, std::string>> rows;  // "SCENE EFFECT", column
  std::set<std::string> notProven;
  while (std::getline(in, line)) {
    const std::vector<std::string> fields = csvFields(line);
    ASSERT_EQ(fields.size(), columns.size()) << line;
    auto& row = rows[fields[0] + " " + fields[1]];
    for (size_t i = 0; i < fields.size(); ++i) row[columns[i]] = fields[i];
    EXPECT_TRUE(row["state"].empty() || row["pixels_different"].empty() != row["not_proven"].empty()) << line;
    EXPECT_EQ(row["state"].empty(), row["reason"].empty()) << line;
    if (!row["not_proven"].empty()) notProven.insert(fields[1] + ": " + row["not_proven"]);
  }
  EXPECT_EQ(notProven, (std::set<std::string>{"emitter-sampling: nothing emits", "brute-force: solver.method = matrix",
                                              "writeback: writeback.mode = off", "relight: no indirect light",
                                              "blur: no indirect light"}));
  for (const std::string scene : {"check:lights-off ", "check:plates "}) {
    // An idle window, as planned, is measured and takes nothing; with everything forced on it does.
    auto &planned = rows.at(scene + "as planned"), &forced = rows.at(scene + "all forced on");
    for (const char* idle : {"idle_ms_per_s", "idle_dispatches_per_s", "idle_draws_per_s"}) {
      EXPECT_EQ(std::stod(planned[idle]), 0) << idle;
      EXPECT_GT(std::stod(forced[idle]), 0) << idle;
    }
    EXPECT_GT(std::stod(planned["camera_ms_per_s"]), 0);
    EXPECT_EQ(forced["pixels_different"], "0");
    EXPECT_EQ(forced["light_ms_per_s"], "");  // there are no lights to move
    for (const char* off : {"sun", "point", "spot", "rebuild", "redraw"})
      EXPECT_TRUE(rows.contains(scene + off)) << off;
  }
  for (const char* off : {"emission", "matrix", "specular", "field", "alpha-test", "normal-map"})
    EXPECT_TRUE(rows.contains(std::string("check:lights-off ") + off)) << off;
  EXPECT_GT(std::stod(rows["check:lights-off matrix"]["mib_not_allocated"]), 0);
  EXPECT_EQ(rows["check:lights-off specular"]["mib_not_allocated"], "0.033");  // 48 x 36 x 20 B
}

}  // namespace
}  // namespace irad::test::effects_suite
