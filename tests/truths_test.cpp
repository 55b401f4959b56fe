// Truths that studies share: their recipes name all that pictures depend on, so that leaving one member out fails here,
// and the folder gives back the pictures of the very recipe and no others. Without a device.
#include "gi/study/truths.h"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <map>
#include <set>

#include "app/version.h"
#include "gi/check/path_tracer.h"
#include "gi/sky.h"
#include "renderer/base/error.h"
#include "renderer/base/output_file.h"
#include "renderer/base/sha256.h"
#include "renderer/scene/scene.h"
#include "renderer/scene/scene_content.h"
#include "renderer/scene/sky_image.h"
#include "tests/support.h"

namespace irad::test::truths_suite {
namespace {

namespace fs = std::filesystem;

std::shared_ptr<const SkyTexels> texels(float value) {
  return std::make_shared<SkyTexels>(SkyTexels{{2, 1}, {glm::vec3(value), glm::vec3(1)}});
}

std::shared_ptr<const SkyImage> skyImage(float whole, float without, std::optional<SkySun> sun) {
  return std::make_shared<SkyImage>(
      SkyImage{.path = "sky.exr", .sha256 = "s", .whole = texels(whole), .texels = texels(without), .sun = sun});
}

/// One triangle that has a texture in every place, a light and a sky.
Scene smallScene() {
  Scene s;
  s.path = "room.glb", s.sha256 = "file";
  s.boundsMin = glm::vec3(-1), s.boundsMax = glm::vec3(1);
  s.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  s.normals.assign(3, {0, 0, 1}), s.tangents.assign(3, {1, 0, 0, 1});
  s.uv0.assign(3, glm::vec2(0)), s.uv1.assign(3, glm::vec2(0)), s.colors.assign(3, glm::vec4(1));
  s.indices = {0, 1, 2}, s.draws = {{0, 0, 3}};
  s.materials.resize(1);
  s.images = {{"tiles", 1, 1, true, {1, 2, 3, 255}}};
  s.lights.resize(1);
  s.sky = skyImage(3, 2, SkySun{{0, 1, 0}, glm::vec3(1)});
  return s;
}

template <class T>
using Changes = std::map<std::string, std::function<void(T&)>>;

Changes<TextureUse> useChanges() {
  return {{"image", [](auto& u) { u.image = 0; }},
          {"u", [](auto& u) { u.sampler.u = static_cast<Wrap>(1); }},
          {"v", [](auto& u) { u.sampler.v = static_cast<Wrap>(1); }},
          {"linearMag", [](auto& u) { u.sampler.linearMag = false; }},
          {"linearMin", [](auto& u) { u.sampler.linearMin = false; }},
          {"mips", [](auto& u) { u.sampler.mips = false; }},
          {"linearMips", [](auto& u) { u.sampler.linearMips = false; }},
          {"anisotropic", [](auto& u) { u.sampler.anisotropic = true; }},
          {"uvSet", [](auto& u) { u.uvSet = 1; }},
          {"transform", [](auto& u) { u.transform[2].y = .5f; }}};
}

Changes<Scene> sceneChanges() {
  Changes<Scene> out{{"origin", [](Scene& s) { s.origin.x = 1e-9; }},
                     {"boundsMin", [](Scene& s) { s.boundsMin.y = -2; }},
                     {"boundsMax", [](Scene& s) { s.boundsMax.z = 2; }},
                     {"positions", [](Scene& s) { s.positions[2].x = 1e-6f; }},
                     {"normals",
                      [](Scene& s) {
                        s.normals[1] = {0, 1, 0};
                      }},
                     {"tangents", [](Scene& s) { s.tangents[0].w = -1; }},
                     {"uv0", [](Scene& s) { s.uv0[0].x = .5f; }},
                     {"uv1", [](Scene& s) { s.uv1[0].x = .5f; }},
                     {"colors", [](Scene& s) { s.colors[0].y = .5f; }},
                     {"indices", [](Scene& s) { std::swap(s.indices[0], s.indices[1]); }},
                     {"draw.material", [](Scene& s) { s.draws[0].material = 1; }},
                     {"draw.firstIndex", [](Scene& s) { s.draws[0].firstIndex = 3; }},
                     {"draw.indexCount", [](Scene& s) { s.draws[0].indexCount = 0; }},
                     {"draws", [](Scene& s) { s.draws.clear(); }},
                     {"another material", [](Scene& s) { s.materials.emplace_back(); }},
                     {"baseColor", [](Scene& s) { s.materials[0].baseColor.b = .5f; }},
                     {"metallic", [](Scene& s) { s.materials[0].metallic = .5f; }},
                     {"roughness", [](Scene& s) { s.materials[0].roughness = .5f; }},
                     {"emission", [](Scene& s) { s.materials[0].emission.r = 1; }},
                     {"normalScale", [](Scene& s) { s.materials[0].normalScale = .5f; }},
                     {"occlusionStrength", [](Scene& s) { s.materials[0].occlusionStrength = .5f; }},
                     {"alphaCutoff", [](Scene& s) { s.materials[0].alphaCutoff = .25f; }},
                     {"alpha", [](Scene& s) { s.materials[0].alpha = AlphaMode::Mask; }},
                     {"transmission", [](Scene& s) { s.materials[0].transmission = .25f; }},
                     {"transmissionTexture",
                      [](Scene& s) {
                        s.materials[0].transmission = .25f;
                        s.materials[0].transmissionTexture.image = 0;
                      }},
                     {"doubleSided", [](Scene& s) { s.materials[0].doubleSided = true; }},
                     {"lambertian", [](Scene& s) { s.materials[0].lambertian = true; }},
                     {"another image", [](Scene& s) { s.images.emplace_back(); }},
                     {"width", [](Scene& s) { s.images[0].width = 2; }},
                     {"height", [](Scene& s) { s.images[0].height = 2; }},
                     {"srgb", [](Scene& s) { s.images[0].srgb = false; }},
                     {"rgba", [](Scene& s) { s.images[0].rgba[2] = 4; }},
                     {"another light", [](Scene& s) { s.lights.emplace_back(); }},
                     {"type", [](Scene& s) { s.lights[0].type = LightType::Spot; }},
                     {"position", [](Scene& s) { s.lights[0].position.z = 1e-9; }},
                     {"direction",
                      [](Scene& s) {
                        s.lights[0].direction = {1, 0, 0};
                      }},
                     {"color", [](Scene& s) { s.lights[0].color.g = .5f; }},
                     {"intensity", [](Scene& s) { s.lights[0].intensity = 2; }},
                     {"range", [](Scene& s) { s.lights[0].range = 2; }},
                     {"innerCos", [](Scene& s) { s.lights[0].innerCos = .9f; }},
                     {"outerCos", [](Scene& s) { s.lights[0].outerCos = .5f; }},
                     {"angle", [](Scene& s) { s.lights[0].angle = .5f; }},
                     {"radius", [](Scene& s) { s.lights[0].radius = .5f; }},
                     {"no sky", [](Scene& s) { s.sky = nullptr; }},
                     {"sky.whole", [](Scene& s) { s.sky = skyImage(4, 2, s.sky->sun); }},
                     {"sky.texels", [](Scene& s) { s.sky = skyImage(3, 1, s.sky->sun); }},
                     {"no sun", [](Scene& s) { s.sky = skyImage(3, 2, std::nullopt); }},
                     {"sun.towards",
                      [](Scene& s) {
                        s.sky = skyImage(3, 2, SkySun{{1, 0, 0}, glm::vec3(1)});
                      }},
                     {"sun.irradiance", [](Scene& s) {
                        s.sky = skyImage(3, 2, SkySun{{0, 1, 0}, glm::vec3(2)});
                      }}};
  TextureUse Material::*const uses[] = {&Material::baseColorTexture, &Material::metallicRoughnessTexture,
                                        &Material::normalTexture, &Material::occlusionTexture,
                                        &Material::emissiveTexture};
  for (size_t i = 0; i < std::size(uses); ++i)
    for (const auto& [name, change] : useChanges())
      out["texture " + std::to_string(i) + " " + name] = [use = uses[i], made = change](Scene& s) {
        made(s.materials[0].*use);
      };
  return out;
}

TEST(SceneContents, EveryMemberOfAPictureCounts) {
  const std::string before = sceneContent(smallScene());
  EXPECT_EQ(before, sceneContent(smallScene()));
  std::set<std::string> all{before};
  for (const auto& [name, change] : sceneChanges()) {
    Scene changed = smallScene();
    change(changed);
    EXPECT_TRUE(all.insert(sceneContent(changed)).second)
        << name << " is the same scene as before, or as another change";
  }
}

TEST(SceneContents, WhereItComesFromDoesNot) {
  Scene s = smallScene();
  const std::string before = sceneContent(s);
  s.path = "elsewhere/room.glb", s.sidecar = "room.glb.irad.json", s.warnings = {"odd"};
  s.cameras.resize(2), s.bookmarks.resize(1), s.defaultCamera = true;
  s.materials[0].name = "wall", s.lights[0].name = "lamp", s.images[0].name = "bricks";
  EXPECT_EQ(sceneContent(s), before);
}

/// What recipes are of.
struct Asked {
  std::string program = "irad 1 (abc)", scene = "content", sceneName = "room", view = "indirect", device = "a GPU";
  Camera camera;
  glm::uvec2 size{16, 8};
  Sky sky{.texels = texels(1), .whole = texels(2), .sun = SkySun{{0, 1, 0}, glm::vec3(1)}};
  TraceOptions options;
  Settings settings;

  TruthSubject subject() const {
    return {.program = program, .scene = scene, .sceneName = sceneName, .camera = camera, .size = size, .view = view};
  }
  TruthRecipe traced() const { return tracedTruth(subject(), sky, options); }
  TruthRecipe drawn() const { return drawnTruth(subject(), settings, device); }
};

const Changes<Asked> kOfBoth{{"program", [](Asked& a) { a.program += "-dirty"; }},
                             {"scene", [](Asked& a) { a.scene = "other"; }},
                             {"view", [](Asked& a) { a.view = "lit"; }},
                             {"size.x", [](Asked& a) { a.size.x = 8; }},
                             {"size.y", [](Asked& a) { a.size.y = 16; }},
                             {"position", [](Asked& a) { a.camera.position.y = 1e-12; }},
                             {"orientation", [](Asked& a) { a.camera.orientation.z = 1e-7f; }},
                             {"orthographic", [](Asked& a) { a.camera.orthographic = true; }},
                             {"yfov", [](Asked& a) { a.camera.yfov = .5f; }},
                             {"ymag", [](Asked& a) { a.camera.ymag = 2; }},
                             {"aspect", [](Asked& a) { a.camera.aspect = 2; }},
                             {"znear", [](Asked& a) { a.camera.znear = .01f; }},
                             {"zfar", [](Asked& a) { a.camera.zfar = 10; }}};

void expectAllDiffer(const Changes<Asked>& changes, TruthRecipe (Asked::*recipe)() const) {
  const TruthRecipe before = (Asked().*recipe)();
  EXPECT_EQ(before.name(), (Asked().*recipe)().name());
  std::set<std::string> made{before.made}, hashes{before.name().substr(before.label.size())};
  for (const auto& [name, change] : changes) {
    Asked changed;
    change(changed);
    const TruthRecipe after = (changed.*recipe)();
    EXPECT_TRUE(made.insert(after.made).second) << name << " is no part of the recipe: " << after.made;
    EXPECT_TRUE(hashes.insert(after.name().substr(after.label.size())).second) << name << " is not in the name's hash";
  }
}

TEST(TruthRecipes, OfTracedOnesNameAllThatTheTracerIsGiven) {
  Changes<Asked> changes = kOfBoth;
  const Changes<Asked> own{{"samples", [](Asked& a) { a.options.samples = 128; }},
                           {"seed", [](Asked& a) { a.options.seed = 2; }},
                           {"centred", [](Asked& a) { a.options.centred = true; }},
                           {"glossy", [](Asked& a) { a.options.glossy = true; }},
                           {"glossySeen", [](Asked& a) { a.options.glossySeen = true; }},
                           {"bounces", [](Asked& a) { a.options.bounces = 1; }},
                           {"strategy", [](Asked& a) { a.options.strategy = TraceStrategy::lights; }},
                           {"no sky", [](Asked& a) { a.sky.texels = nullptr; }},
                           {"sky.texels", [](Asked& a) { a.sky.texels = texels(7); }},
                           {"sky.whole", [](Asked& a) { a.sky.whole = texels(7); }},
                           {"sky.turn", [](Asked& a) { a.sky.turn = .5f; }},
                           {"sky.scale", [](Asked& a) { a.sky.scale.g = 2; }},
                           {"no sun", [](Asked& a) { a.sky.sun = std::nullopt; }},
                           {"sun.towards",
                            [](Asked& a) {
                              a.sky.sun->towards = {1, 0, 0};
                            }},
                           {"sun.irradiance", [](Asked& a) { a.sky.sun->irradiance.b = 2; }},
                           {"sky.model", [](Asked& a) { a.sky.model.w = 3; }},
                           {"ground.albedo", [](Asked& a) { a.sky.ground.albedo = .5f; }},
                           {"ground.sun", [](Asked& a) { a.sky.ground.sun.r = 1; }}};
  changes.insert(own.begin(), own.end());
  expectAllDiffer(changes, &Asked::traced);
  Asked threads;
  threads.options.threads = 3;
  EXPECT_EQ(threads.traced().name(), Asked().traced().name()) << "no bit depends on it";
}

TEST(TruthRecipes, OfDrawnOnesNameEverySetting) {
  Changes<Asked> changes = kOfBoth;
  changes["device"] = [](Asked& a) { a.device = "another GPU"; };
  for (const Setting& setting : settingTable())
    changes[setting.name] = [&setting](Asked& a) {
      const double before = setting.get(a.settings);
      const double least = setting.choices.empty() ? setting.range.min : 0;
      setting.set(a.settings, before == least ? least + std::max(1.0, setting.range.step) : least);
      ASSERT_NE(setting.get(a.settings), before) << setting.name;
    };
  EXPECT_GT(changes.size(), kOfBoth.size() + 50);
  expectAllDiffer(changes, &Asked::drawn);
  EXPECT_NE(Asked().drawn().name(), Asked().traced().name());
}

TEST(TruthRecipes, HaveNamesThatPeopleRead) {
  Asked asked;
  asked.camera.name = "main";
  EXPECT_TRUE(asked.traced().name().starts_with("room-main-indirect-")) << asked.traced().name();
  EXPECT_EQ(asked.traced().name().size(), std::string("room-main-indirect-0123456789").size());
  asked.camera.name = "";
  EXPECT_EQ(asked.traced().label, "room-camera-indirect");
  EXPECT_EQ(asked.traced().made, Asked().traced().made) << "names are for people";
  asked.camera.name = "../über/die Tür", asked.sceneName = "";
  EXPECT_EQ(asked.traced().label, "scene-..___ber_die_T__r-indirect") << "no folder, no space";
}

TEST(Programs, OfTreesWithChangesAreToldApartByTheirBytes) {
  const std::string identity = app::programIdentity("/proc/self/exe"), commit = app::versionCommit();
  EXPECT_TRUE(identity.starts_with(std::string(app::versionNumber()) + " (" + commit)) << identity;
  const bool names = commit != "unknown" && !commit.ends_with("-dirty");
  EXPECT_NE(contains(identity, sha256File("/proc/self/exe").substr(0, 12)), names) << identity;
}

class Store : public ::testing::Test {
 protected:
  static std::vector<glm::vec4> grey(float value) { return std::vector<glm::vec4>(128, glm::vec4(value, .5f, 3, 1)); }
  void keep(const TruthRecipe& recipe, int half, float value) const {
    store().keep(recipe, half, {16, 8}, grey(value), {});
  }
  TruthStore store() const { return TruthStore(folder_.path / "truths"); }
  fs::path file(const TruthRecipe& recipe, const char* end) const {
    return folder_.path / "truths" / (recipe.name() + end);
  }
  std::string picture(const char* half) const { return half + std::string(linearExtension()); }

  TemporaryFolder folder_;
};

TEST_F(Store, GivesBackTheHalvesOfTheVeryRecipe) {
  const TruthRecipe one = Asked().traced(), other = Asked().drawn();
  EXPECT_FALSE(store().find(one, 0));
  keep(one, 0, .25f);
  EXPECT_FALSE(store().has(one)) << "half of it";
  keep(one, 1, .75f);
  ASSERT_TRUE(store().has(one));
  EXPECT_EQ(store().find(one, 0)->pixels, grey(.25f));
  EXPECT_EQ(store().find(one, 1)->pixels, grey(.75f));
  EXPECT_FALSE(store().has(other));
  Asked changed;
  changed.options.samples = 2;
  EXPECT_FALSE(store().has(changed.traced()));
  for (const auto& entry : fs::directory_iterator(folder_.path / "truths"))
    EXPECT_TRUE(entry.path().filename().string().starts_with(one.name() + ".")) << entry.path();
}

TEST_F(Store, TakesNoPictureThatIsNotTheOneWritten) {
  const TruthRecipe recipe = Asked().traced();
  keep(recipe, 0, .25f), keep(recipe, 1, .75f);
  // Another truth's picture under its name: whole, of the right size, and stale.
  fs::copy_file(file(recipe, picture(".a").c_str()), file(recipe, picture(".b").c_str()),
                fs::copy_options::overwrite_existing);
  std::string spoilt;
  EXPECT_TRUE(store().find(recipe, 0, &spoilt));
  EXPECT_EQ(spoilt, "");
  EXPECT_FALSE(store().find(recipe, 1, &spoilt));
  EXPECT_TRUE(contains(spoilt, "not the picture that was written")) << spoilt;
  keep(recipe, 1, .75f);
  EXPECT_TRUE(store().has(recipe)) << "made anew";
  fs::remove(file(recipe, picture(".a").c_str()));
  EXPECT_FALSE(store().find(recipe, 0, &spoilt));
  EXPECT_TRUE(contains(spoilt, "is gone")) << spoilt;
  // Pictures that nothing vouches for: a run was killed before it could.
  keep(recipe, 0, .25f);
  fs::remove(file(recipe, ".json"));
  EXPECT_FALSE(store().find(recipe, 0) || store().find(recipe, 1));
}

TEST_F(Store, RefusesARecipeThatIsNotOfItsName) {
  const TruthRecipe recipe = Asked().traced();
  keep(recipe, 0, .25f), keep(recipe, 1, .75f);
  std::string json = slurp(file(recipe, ".json"));
  const std::string member = "\"samples\": 64";
  ASSERT_TRUE(contains(json, member)) << json;
  json.replace(json.find(member), member.size(), "\"samples\": 32");
  std::ofstream(file(recipe, ".json")) << json;
  const auto refusal = [&] {
    try {
      (void)store().find(recipe, 0);
      return std::string("none");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_TRUE(contains(refusal(), "instead of ") && contains(refusal(), "\"samples\":32")) << refusal();
  std::ofstream(file(recipe, ".json")) << "{}";
  EXPECT_TRUE(contains(refusal(), "remove it")) << refusal();
}

}  // namespace
}  // namespace irad::test::truths_suite
