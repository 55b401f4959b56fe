// Reflections that are written back: mirrors that light each other, and floors at angles to the voxels.
#include <fmt/format.h>

#include <glm/gtc/matrix_transform.hpp>

#include "gi/check/cases.h"
#include "gi/check/scenes.h"
#include "gi/check/writeback_figures.h"
#include "gi/lighting.h"

namespace irad {
namespace {

constexpr glm::uvec2 kFloorPicture(96, 72);

Settings writingBack(Settings settings, WritebackMode mode) {
  settings.writeback.mode = mode;
  // The preset `thesis` has its loss of light in lambda, which is not what is asked about here.
  settings.solver.gpu.lambda = 1;
  return settings;
}

/// Two walls of perfect mirrors, .8 apart, and a lamp of M = 1 above; what else there is is grey.
Scene mirrorsScene() {
  SceneBuilder b;
  const uint32_t grey = b.material(glm::vec3(0.5f)), mirror = b.material(glm::vec3(1)),
                 lamp = b.material(glm::vec3(0), glm::vec3(1));
  b.edit(mirror).metallic = 1;
  b.edit(mirror).roughness = 0;
  b.box({mirror, mirror, grey, lamp, grey, grey}, {-0.4f, -0.5f, -1}, {0.4f, 0.5f, 1}, /*inward=*/true);
  b.camera({0, 0, 0.95}, {0, 0, -1});
  return b.finish("facing mirrors");
}

/// The same with walls that all emit M = 1 and reflect as much as they may, half of it as mirrors: what nears 20 E.
Scene brightMirrorsScene() {
  SceneBuilder b;
  const uint32_t wall = b.material(glm::vec3(1), glm::vec3(1));
  b.edit(wall).metallic = 0.5f;
  b.edit(wall).roughness = 0;
  b.box(std::vector<uint32_t>(6, wall), {-0.4f, -0.5f, -1}, {0.4f, 0.5f, 1}, /*inward=*/true);
  b.camera({0, 0, 0.95}, {0, 0, -1});
  return b.finish("bright mirrors");
}

void facingMirrorsCase(CheckRun& run) {
  // What a single reflection brings, .95 of the lamp and .45 of walls with B = 2, so that doing nothing does not pass.
  constexpr double leastW = .9;
  const auto judge = [&](const char* walls, const Scene& scene, WritebackMode mode) {
    const auto pipeline = run.prepare(scene, writingBack(run.small(), mode));
    const WritebackFigures f =
        measureWriteback(run.context, *pipeline, pipeline->scene().cameras.at(0), kFloorPicture, /*frames=*/2);
    const std::vector<glm::vec3> b = run.read(*pipeline, pipeline->lighting().radiosity);
    double largest = 0;
    for (const glm::vec3& v : b) largest = std::max({largest, double{v.x}, double{v.y}, double{v.z}});
    const auto name = [&](const char* figure) { return fmt::format("{}, {}: {}", walls, nameOf(mode), figure); };
    run.atMost(name("largest B / E"), largest, 20);
    run.none(name("B not finite"), countNonFinite(b));
    run.atLeast(name("largest W / E"), f.report.largest, leastW, 2 * leastW);
    run.info(name("rounds"), f.rounds.rounds);
    // Where several fragments write, which of them is last may change from picture to picture.
    if (mode == WritebackMode::compute)
      run.require(name("settles"), f.rounds.settled);
    else
      run.info(name("settles"), f.rounds.settled ? 1 : 0);
  };
  for (const WritebackMode mode : {WritebackMode::mask, WritebackMode::compute}) {
    judge("mirrors", mirrorsScene(), mode);
    judge("bright mirrors", brightMirrorsScene(), mode);
  }
}

/// A glossy floor, a wall behind it and a lamp above, turned as one, and the camera with them.
Scene floorScene(const glm::mat3& turn) {
  SceneBuilder b;
  const uint32_t gloss = b.material({0.9f, 0.85f, 0.8f}), wall = b.material({0.7f, 0.3f, 0.2f}),
                 lamp = b.material(glm::vec3(0), {4, 3, 2});
  b.edit(gloss).metallic = 1;
  b.edit(gloss).roughness = 0.15f;
  const auto quad = [&](uint32_t m, glm::vec3 p, glm::vec3 q, glm::vec3 r, glm::vec3 s) {
    b.quad(m, turn * p, turn * q, turn * r, turn * s);
  };
  quad(gloss, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
  quad(wall, {-1, 0, -1}, {1, 0, -1}, {1, 1.2f, -1}, {-1, 1.2f, -1});
  quad(lamp, {-0.4f, 1.2f, -0.6f}, {0.4f, 1.2f, -0.6f}, {0.4f, 1.2f, 0.2f}, {-0.4f, 1.2f, 0.2f});
  const glm::dmat3 to(turn);
  b.camera(to * glm::dvec3(0, 0.9, 2.2), to * glm::dvec3(0, 0.2, -0.2));
  return b.finish("glossy floor");
}

glm::mat3 turnedAbout(float degrees, const glm::vec3& axis) {
  return glm::mat3(glm::rotate(glm::mat4(1.0f), glm::radians(degrees), axis));
}
Scene flatFloor() {
  return floorScene(glm::mat3(1.0f));
}
Scene slopingFloor() {
  return floorScene(turnedAbout(45, {0, 0, 1}));
}
Scene tiltedFloor() {
  return floorScene(turnedAbout(31, glm::normalize(glm::vec3(1, 2, 3))));
}

void floorCase(CheckRun& run, Scene (*scene)()) {
  constexpr uint32_t frames = 8;
  const auto measured = [&](WritebackMode mode) {
    const auto pipeline = run.prepare(scene(), writingBack(run.small(), mode));
    return measureWriteback(run.context, *pipeline, pipeline->scene().cameras.at(0), kFloorPicture, frames);
  };
  const double without = measured(WritebackMode::off).meanB;
  for (const WritebackMode mode : {WritebackMode::mask, WritebackMode::compute}) {
    const WritebackFigures f = measured(mode);
    const auto name = [&](const char* figure) { return fmt::format("{}: {}", nameOf(mode), figure); };
    const double gain = f.meanB / without - 1;
    if (mode == WritebackMode::mask) {
      run.info(name("share of visible facets written"), f.share(f.report.written()));
      run.info(name("share with several writers"), f.share(f.several()));
      run.info(name("flicker of B"), f.flicker);
      run.info(name("gain in light"), gain);
      continue;
    }
    run.near(name("share of visible facets written"), f.share(f.report.written()), 1, 0);
    run.near(name("flicker of B"), f.flicker, 0, 0);
    run.require(name("settles"), f.rounds.settled);
    run.atLeast(name("gain in light"), gain, 0, .05);
  }
}

}  // namespace

std::vector<CheckCase> writebackCases() {
  const char *visible = "compute: every visible facet, the same B", *mark = "1; 0";
  return {
      {.name = "facing-mirrors",
       .setup = "two mirrors, writeback on",
       .oracle = "largest B <= 20 E, settles",
       .mark = "finite",
       .run = facingMirrorsCase,
       .scene = mirrorsScene},
      {.name = "floor-flat",
       .setup = "writeback of a glossy floor along the voxels",
       .oracle = visible,
       .mark = mark,
       .run = [](CheckRun& run) { floorCase(run, flatFloor); },
       .scene = flatFloor},
      {.name = "floor-45",
       .setup = "the same turned by 45 degrees",
       .oracle = visible,
       .mark = mark,
       .run = [](CheckRun& run) { floorCase(run, slopingFloor); },
       .scene = slopingFloor},
      {.name = "floor-tilted",
       .setup = "the same turned by 31 degrees about (1, 2, 3)",
       .oracle = visible,
       .mark = mark,
       .run = [](CheckRun& run) { floorCase(run, tiltedFloor); },
       .scene = tiltedFloor},
  };
}

}  // namespace irad
