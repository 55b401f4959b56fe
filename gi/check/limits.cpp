// No light, no reflection, all reflection, and albedos that cannot be.
#include <cmath>
#include <cstring>
#include <limits>

#include "gi/check/cases.h"
#include "gi/check/scenes.h"
#include "gi/facets.h"
#include "gi/lighting.h"

namespace irad {
namespace {

Scene darkRoom() {
  SceneBuilder b;
  const uint32_t m = b.material(glm::vec3(0.9f));
  b.box({m, m, m, m, m, m}, glm::vec3(-1), glm::vec3(1), /*inward=*/true);
  return b.finish("dark room");
}

/// Components whose bits are not those of +0.
uint64_t countNonZero(const std::vector<glm::vec3>& values) {
  uint64_t n = 0;
  for (const glm::vec3& v : values)
    for (int c = 0; c < 3; ++c) {
      uint32_t bits;
      std::memcpy(&bits, &v[c], sizeof(bits));
      n += bits != 0;
    }
  return n;
}

void darkCase(CheckRun& run) {
  const Settings settings = run.small();  // what rays meet is dark
  const auto pipeline = run.prepare(darkRoom(), settings);
  // At rest the solver stops after a look at two sweeps.
  uint32_t sweeps = 0;
  while (sweeps < 1000) {
    pipeline->invalidate(Redo::Solve);
    pipeline->prepare();
    sweeps += pipeline->lighting().report.sweeps;
  }
  run.info("sweeps", sweeps);
  const Lighting& light = pipeline->lighting();
  run.none("B not 0", countNonZero(run.read(*pipeline, light.radiosity)));
  run.none("H not 0", countNonZero(run.read(*pipeline, light.indirect)));
  const CheckPicture lit = run.picture(*pipeline, pipeline->scene().cameras[0], VIEW_LIT, {64, 64});
  uint64_t bright = 0;
  for (const glm::vec4& p : lit.pixels) bright += p.x != 0 || p.y != 0 || p.z != 0;
  run.none("pixels not black", bright);
}

void lightsOffCase(CheckRun& run) {
  Settings settings = run.settings;
  settings.matrix.gpu.rays = 64;  // all meet the same B
  const auto pipeline = run.prepare(darkRoom(), settings);
  const size_t facets = pipeline->facets().count;
  run.setDirect(*pipeline, std::vector<glm::vec3>(facets, glm::vec3(1, 2, 3)));
  pipeline->prepare();
  const double lit = spread(run.read(*pipeline, pipeline->lighting().radiosity)).mean;
  run.info("B lit", lit);
  run.setDirect(*pipeline, std::vector<glm::vec3>(facets, glm::vec3(0)));
  pipeline->prepare({}, 10);
  const double after = spread(run.read(*pipeline, pipeline->lighting().radiosity)).mean;
  run.near("B after 10 sweeps / (.9^10 lit)", after / (lit * std::pow(0.9, 10)), 1, 0.01);
  // A few per frame, as the window does it.
  uint32_t sweeps = 10;
  const auto dark = [&] {
    return countNonZero(run.read(*pipeline, pipeline->lighting().radiosity)) +
           countNonZero(run.read(*pipeline, pipeline->lighting().indirect));
  };
  while (sweeps < 200 && dark() != 0) {
    pipeline->invalidate(Redo::Solve);
    pipeline->prepare({}, 4);
    sweeps += pipeline->lighting().report.sweeps;
  }
  run.none("B and H not 0 after 200 sweeps", dark());
  run.info("sweeps to exact 0", sweeps);
}

Scene zeroRoom() {
  return furnaceBox(0.0f);
}

void albedoZeroCase(CheckRun& run) {
  const auto pipeline = run.prepare(zeroRoom());
  const Lighting& light = pipeline->lighting();
  const std::vector<glm::vec3> first = run.read(*pipeline, light.indirect);
  pipeline->invalidate(Redo::Solve);
  pipeline->prepare();
  const std::vector<glm::vec3> b = run.read(*pipeline, light.radiosity), h = run.read(*pipeline, light.indirect);
  uint64_t reflected = 0, changed = 0;
  for (size_t i = 0; i < b.size(); ++i) {
    reflected += b[i] != run.settings.solver.gpu.lambda * glm::vec3(1);  // B = M
    changed += h[i] != first[i];
  }
  run.none("facets with B other than M", reflected);
  run.none("facets whose H changes after the first gather", changed);
}

Scene whiteRoom() {
  return furnaceBox(1.0f);
}

void albedoOneCase(CheckRun& run) {
  Settings settings = run.settings;
  settings.matrix.gpu.rays = 64;  // all meet the same B
  const auto pipeline = run.prepare(whiteRoom(), settings);
  const std::vector<glm::vec3> b = run.read(*pipeline, pipeline->lighting().radiosity);
  run.near("mean B / E", spread(b).mean, 50, 0.05);
  run.atMost("largest B / E", spread(b).most, 50 * 1.001);
  run.none("not finite", countNonFinite(b));
  // Of every facet all pieces.
  run.atLeast("pieces reported as clamped / facets",
              static_cast<double>(pipeline->facets().clampedAlbedo) / static_cast<double>(b.size()), 1);
}

/// Walls of albedo 2, -1, NaN and inf, and two of .5.
Scene badRoom() {
  SceneBuilder b;
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  std::vector<uint32_t> walls;
  for (const float rho : {2.0f, -1.0f, nan, inf, 0.5f, 0.5f}) walls.push_back(b.material(glm::vec3(rho), glm::vec3(1)));
  b.box(walls, glm::vec3(-1), glm::vec3(1), /*inward=*/true);
  return b.finish("albedo-bad");
}

void albedoBadCase(CheckRun& run) {
  const auto pipeline = run.prepare(badRoom());
  const HostFacets facets = run.facets(*pipeline);
  uint64_t outside = 0, bad = 0;
  for (size_t i = 0; i < facets.count(); ++i) {
    const float rho = facets.albedo[i].x;
    outside += !(rho >= 0 && rho <= 0.98001f);
    bad += std::abs(rho - 0.5f) > 1e-3f;
  }
  run.none("facets with albedo outside [0, .98]", outside);
  run.atLeast("pieces reported as clamped / facets of the four walls",
              static_cast<double>(pipeline->facets().clampedAlbedo) / static_cast<double>(bad), 1);
  run.none("B not finite", countNonFinite(run.read(*pipeline, pipeline->lighting().radiosity)));
  run.none("pixels not finite",
           countNonFinite(run.picture(*pipeline, pipeline->scene().cameras[0], VIEW_LIT, {64, 64})));
}

glm::dvec3 firstGather(const glm::dvec3&, const glm::dvec3&) {
  return glm::dvec3(1);
}
glm::dvec3 clampedLight(const glm::dvec3&, const glm::dvec3&) {
  return glm::dvec3(50);
}

}  // namespace

std::vector<CheckCase> limitCases() {
  return {
      {"lights-off", "closed room, rho = .9, lights cut", "rho^k decay, then exact 0", "0 bits within 200 sweeps",
       lightsOffCase, darkRoom, noLight},
      {"dark", "closed room, no light, 1,000 sweeps", "0", "bits zero", darkCase, darkRoom, noLight},
      {"albedo-zero", "furnace, rho = 0", "no bounce beyond the first gather", "exact", albedoZeroCase, zeroRoom,
       firstGather},
      {"albedo-one", "furnace, rho = 1", "clamped to .98: 50 E, finite, reported", "+- .1 %", albedoOneCase, whiteRoom,
       clampedLight},
      {"albedo-bad", "walls of albedo 2, -1, NaN, infinity", "clamped, counted, reported", "finite", albedoBadCase,
       badRoom},
  };
}

}  // namespace irad
