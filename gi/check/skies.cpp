// Skies: an even one in a sphere that is open to it, and Preetham's above its ground.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "gi/check/cases.h"
#include "gi/check/path_tracer.h"
#include "gi/check/pictures.h"
#include "gi/check/scenes.h"
#include "gi/lighting.h"
#include "gi/sky.h"
#include "renderer/base/error.h"

namespace irad {
namespace {

using std::numbers::pi;

constexpr uint32_t kRings = 64, kOpen = 16;
/// The share of the whole sphere that is open.
double openShare() {
  return 0.5 * (1 - std::cos(pi * kOpen / kRings));
}

Scene openSphere() {
  SceneBuilder b;
  b.zone(b.material(glm::vec3(0.5f)), glm::vec3(0), 1, /*inward=*/true, kRings, kOpen, kRings);
  return b.finish("open sphere");
}

/// A sphere sees each of its parts, and through its opening the sky, by its share of the area, so that B = rho (pi L f
/// + B (1 - f)).
void skySphereCase(CheckRun& run) {
  Settings settings = run.settings;
  settings.sky.source = SkySource::constant;
  const auto pipeline = run.prepare(openSphere(), settings);
  const std::vector<double> area = run.facets(*pipeline).area;
  const double f = openShare();
  for (const float rho : {0.1f, 0.5f, 0.8f, 0.9f, 0.95f}) {
    run.setAlbedo(*pipeline, std::vector<glm::vec3>(area.size(), glm::vec3(rho)));
    pipeline->prepare();
    const std::vector<glm::vec3> b = run.read(*pipeline, pipeline->lighting().radiosity);
    double sum = 0, all = 0;
    for (size_t i = 0; i < b.size(); ++i) sum += area[i] * double{b[i].x}, all += area[i];
    const double expected = rho * pi * f / (1 - rho * (1 - f));
    run.near(fmt::format("mean B / expected, rho {}", rho), sum / all / expected, 1, 0.005);
  }
}

/// A room that is open to the sky and its sun; all of it Lambertian, as the path tracer has it.
Scene roomUnderASky() {
  SceneBuilder b = stillLife(/*light=*/0);
  b.sun(glm::normalize(glm::vec3(0.5f, -0.8f, -1)), 3);
  Scene scene = b.finish("room under a sky");
  for (Material& m : scene.materials) m.lambertian = true, m.metallic = 0, m.roughness = 1;
  return scene;
}

/// H of a sheet that faces down is what the ground sends up, the albedo times what comes down; and a picture of a room
/// is the path tracer's.
void skyGroundCase(CheckRun& run) {
  Settings settings = run.settings;
  settings.sky.source = SkySource::preetham;
  settings.sky.ground = 0.5f;
  settings.effects.matrix = EffectMode::on;  // a black sheet shows no H
  const glm::vec3 towards = glm::normalize(glm::vec3(1, 1, 1));
  SceneBuilder sheet;
  sheet.quad(sheet.material(glm::vec3(0)), {-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1});
  sheet.sun(-towards, 3);
  const auto above = run.prepare(sheet.finish("sheet"), settings);
  double down = 0;
  constexpr int kRows = 256, kColumns = 1024;
  for (int i = 0; i < kRows; ++i)
    for (int k = 0; k < kColumns; ++k) {
      const double y = std::sqrt((i + 0.5) / kRows), across = std::sqrt(1 - y * y), phi = 2 * pi * (k + 0.5) / kColumns;
      const glm::vec3 d(glm::dvec3(across * std::sin(phi), y, -across * std::cos(phi)));
      down += pi * double{above->sky().radiance(d).x} / (kRows * kColumns);
    }
  const std::vector<double> area = run.facets(*above).area;
  const std::vector<glm::vec3> h = run.read(*above, above->lighting().indirect);
  double sum = 0, all = 0;
  for (size_t i = 0; i < h.size(); ++i) sum += area[i] * double{h[i].x}, all += area[i];
  run.near("sheet: H / expected", sum / all / (0.5 * (down + 3 * double{towards.y})), 1, 0.005);

  const auto room = run.prepare(roomUnderASky(), settings);
  constexpr glm::uvec2 kSize(64, 48);
  const Camera& camera = room->scene().cameras.at(0);
  const CheckPicture seen = run.picture(*room, camera, VIEW_LIT, kSize);
  if (!hasPathTracer()) throw WorkError("the room could not be judged: this build has no path tracer (IRAD_EMBREE)");
  const TracedPicture truth =
      makePathTracer(room->scene(), room->sky())->render(camera, kSize, {.samples = run.samples(512), .centred = true});
  const TruthError error = compare(seen, truth.lit);
  run.near("room: mean / truth", error.ratio, 1, 0.03);
  run.atMost("room: relMSE", error.relMse, 0.02);
  run.info("room: truth's standard error / mean", error.uncertainty);
}

}  // namespace

std::vector<CheckCase> skyCases() {
  return {
      {"sky-sphere", "sphere, open by a cone of 45 degrees, under an even sky", "B = rho pi L f/(1 - rho (1 - f))",
       "+- .5 %", skySphereCase, openSphere},
      {"sky-ground", "Preetham's sky with the scene's sun: a sheet above its ground, an open room",
       "H = albedo x what comes down; a path tracer", "H .5 %; mean 3 %, relMSE .02", skyGroundCase, roomUnderASky},
  };
}

}  // namespace irad
