// Blended surfaces: panes, a tinted one, a curtain, a pane in front of a lamp, in a closed room, against the path
// tracer, which decides at each of them by chance.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "gi/check/cases.h"
#include "gi/check/path_tracer.h"
#include "gi/check/pictures.h"
#include "gi/check/scenes.h"
#include "renderer/base/error.h"

namespace irad {
namespace {

constexpr glm::uvec2 kGlassPicture(96, 64);

/// A closed room of 2 x 1.2 x 1.2 with two cameras, which look at each other's half.
SceneBuilder closedRoom() {
  SceneBuilder b;
  const uint32_t floor = b.material({0.6f, 0.55f, 0.5f}), left = b.material({0.7f, 0.3f, 0.25f}),
                 right = b.material({0.3f, 0.5f, 0.7f}), rest = b.material(glm::vec3(0.7f));
  b.box({left, right, floor, rest, rest, rest}, {-1, 0, -0.6f}, {1, 1.2f, 0.6f}, /*inward=*/true);
  b.camera({-0.9, 0.7, 0.5}, {0.6, 0.4, -0.2});
  b.camera({0.9, 0.7, 0.5}, {-0.6, 0.4, -0.2});
  return b;
}
void ceilingLamp(SceneBuilder& b, float x) {
  const uint32_t lamp = b.material(glm::vec3(0), glm::vec3(20));
  b.quad(lamp, {x - 0.2f, 1.1f, -0.2f}, {x + 0.2f, 1.1f, -0.2f}, {x + 0.2f, 1.1f, 0.2f}, {x - 0.2f, 1.1f, 0.2f});
}
uint32_t glass(SceneBuilder& b, const glm::vec3& albedo, float alpha) {
  const uint32_t material = b.material(albedo, glm::vec3(0), /*doubleSided=*/true);
  b.edit(material).alpha = AlphaMode::Blend;
  b.edit(material).baseColor.a = alpha;
  return material;
}
/// Across the room.
void acrossRoom(SceneBuilder& b, uint32_t material, float x) {
  b.quad(material, {x, 0, -0.6f}, {x, 0, 0.6f}, {x, 1.2f, 0.6f}, {x, 1.2f, -0.6f});
}

/// Lambertian, as the light of the path tracer is: the lobe of a plain material adds 2 to 3 % to such a room.
Scene diffuse(Scene scene) {
  for (Material& material : scene.materials) material.lambertian = true;
  return scene;
}

Scene paneScene() {
  SceneBuilder b = closedRoom();
  ceilingLamp(b, -0.5f);
  acrossRoom(b, glass(b, glm::vec3(0.8f), 0.1f), 0.03f);
  return diffuse(b.finish("glass-pane"));
}

/// Folds across the room whose alpha is .1 to .9, a weave that fades downwards.
Scene curtainScene() {
  SceneBuilder b = closedRoom();
  ceilingLamp(b, -0.5f);
  const uint32_t cloth = glass(b, {0.8f, 0.7f, 0.4f}, 1.0f);
  constexpr int kFolds = 8;
  for (int i = 0; i < kFolds; ++i) {
    const float from = -0.6f + 1.2f * i / kFolds, to = -0.6f + 1.2f * (i + 1) / kFolds;
    const float x = i % 2 == 0 ? 0.0f : 0.08f, next = i % 2 == 0 ? 0.08f : 0.0f;
    b.quad(cloth, {x, 0, from}, {next, 0, to}, {next, 1.2f, to}, {x, 1.2f, from});
  }
  SceneImage weave{.name = "weave", .width = 64, .height = 64, .srgb = true, .rgba = {}};
  for (uint32_t y = 0; y < weave.height; ++y)
    for (uint32_t x = 0; x < weave.width; ++x) {
      const double thread = 0.5 + 0.5 * std::sin(0.8 * x) * std::sin(0.8 * y), fade = 1 - y / 64.0;
      weave.rgba.insert(weave.rgba.end(),
                        {255, 255, 255, static_cast<uint8_t>(255 * (0.1 + 0.8 * (0.4 * thread + 0.6 * fade)))});
    }
  b.edit(cloth).baseColorTexture.image = 0;
  Scene scene = diffuse(b.finish("glass-curtain"));
  scene.images.push_back(std::move(weave));
  for (size_t i = 0; i < scene.positions.size(); ++i)
    scene.uv0[i] = {scene.positions[i].z / 1.2f + 0.5f, 1 - scene.positions[i].y / 1.2f};
  return scene;
}

Scene lampPaneScene() {
  SceneBuilder b = closedRoom();
  ceilingLamp(b, 0);
  const uint32_t pane = glass(b, glm::vec3(0.5f), 0.4f);
  b.quad(pane, {-0.4f, 0.9f, -0.4f}, {0.4f, 0.9f, -0.4f}, {0.4f, 0.9f, 0.4f}, {-0.4f, 0.9f, 0.4f});
  return diffuse(b.finish("glass-lamp"));
}

/// Two panes one behind the other before a light without a size: shadow maps, and rays of facets to the light.
Scene shadowScene() {
  SceneBuilder b = closedRoom();
  b.point({-0.6, 0.8, 0.1}, 2);
  acrossRoom(b, glass(b, glm::vec3(0.6f), 0.25f), 0.03f);
  acrossRoom(b, glass(b, glm::vec3(0.6f), 0.5f), 0.31f);
  return diffuse(b.finish("glass-shadow"));
}

/// A stained pane between a lamp with a point light and the other half: it keeps a tenth of what it would reflect.
Scene tintScene() {
  SceneBuilder b = closedRoom();
  ceilingLamp(b, -0.5f);
  b.point({-0.6, 0.8, 0.1}, 1);
  const uint32_t pane = b.material({0.9f, 0.5f, 0.2f}, glm::vec3(0), /*doubleSided=*/true);
  b.edit(pane).transmission = 0.9f;
  acrossRoom(b, pane, 0.03f);
  return diffuse(b.finish("glass-tint"));
}

/// Each channel's mean over the truth's.
glm::dvec3 ratios(const CheckPicture& picture, const TracedLight& truth) {
  glm::dvec3 sum(0);
  for (const glm::vec4& p : picture.pixels) sum += glm::dvec3(p);
  return sum / static_cast<double>(picture.pixels.size()) / truth.pictureMean;
}

void againstTruth(CheckRun& run, Scene (*make)()) {
  if (!hasPathTracer()) throw WorkError("could not be judged: this build has no path tracer (IRAD_EMBREE)");
  const Scene scene = make();
  const auto pipeline = run.prepare(scene, run.settings);
  const auto tracer = makePathTracer(scene);
  for (size_t c = 0; c < scene.cameras.size(); ++c) {
    const TracedPicture truth =
        tracer->render(scene.cameras[c], kGlassPicture, {.samples = run.samples(1024), .centred = true});
    const CheckPicture picture = run.picture(*pipeline, scene.cameras[c], VIEW_LIT, kGlassPicture);
    const TruthError all = compare(picture, truth.lit);
    run.near(fmt::format("camera {}: mean / truth", c), all.ratio, 1, 0.03);
    run.atMost(fmt::format("camera {}: relMSE", c), all.relMse, 0.02);
    // The light by way of other surfaces alone, of what lies behind panes, too.
    const CheckPicture byOthers = run.picture(*pipeline, scene.cameras[c], VIEW_INDIRECT, kGlassPicture);
    run.near(fmt::format("camera {}: indirect mean / truth", c), compare(byOthers, truth.indirect).ratio, 1, 0.03);
    if (make == tintScene) {
      const glm::dvec3 by = ratios(picture, truth.lit);
      for (int i = 0; i < 3; ++i)
        run.near(fmt::format("camera {}: {} / truth", c, std::array{"red", "green", "blue"}[i]), by[i], 1, 0.03);
    }
    run.info(fmt::format("camera {}: truth's standard error / mean", c), all.uncertainty);
  }
}
template <Scene (*make)()>
void glassCase(CheckRun& run) {
  againstTruth(run, make);
}

}  // namespace

std::vector<CheckCase> glassCases() {
  const char *const oracle = "a path tracer on the triangles", *const mark = "mean 3 %, relMSE .02";
  return {
      {"glass-pane", "a closed room halved by a pane of alpha .1, a lamp in one half", oracle, mark,
       glassCase<paneScene>, paneScene},
      {"glass-curtain", "the same by a curtain in folds, its alpha a texture of .1 to .9", oracle, mark,
       glassCase<curtainScene>, curtainScene},
      {"glass-lamp", "a closed room, a pane of alpha .4 in front of its lamp", oracle, mark, glassCase<lampPaneScene>,
       lampPaneScene},
      {"glass-shadow", "a closed room with a point light, two panes of alpha .25 and .5 one behind the other", oracle,
       mark, glassCase<shadowScene>, shadowScene},
      {"glass-tint", "a closed room halved by a pane that transmits .9 of (.9, .5, .2), lamps in one half", oracle,
       "mean and each channel's 3 %, relMSE .02", glassCase<tintScene>, tintScene},
  };
}

}  // namespace irad
