// Geometry that is degenerate, damaged, without thickness, or all length.
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>

#include "gi/check/cases.h"
#include "gi/check/glb.h"
#include "gi/check/scenes.h"
#include "gi/facets.h"
#include "gi/host_facets.h"
#include "gi/lighting.h"

namespace irad {
namespace {

constexpr glm::uvec2 kInputPicture(96);

CheckPicture picture(CheckRun& run, Pipeline& pipeline, View view) {
  return run.picture(pipeline, pipeline.scene().cameras[0], view, kInputPicture);
}

/// Facets whose light differs, and pixels.
void expectSame(CheckRun& run, const std::string& name, Pipeline& got, Pipeline& want) {
  const std::vector<glm::vec3> a = run.read(got, got.lighting().indirect), b = run.read(want, want.lighting().indirect);
  uint64_t differing = std::max(a.size(), b.size()) - std::min(a.size(), b.size());
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i) differing += a[i] != b[i];
  run.none(name + ": facets whose H differs", differing);
  run.none(name + ": pixels that differ", countDiffering(picture(run, got, VIEW_LIT), picture(run, want, VIEW_LIT)));
}

// ---- degenerate ----

/// Adds triangles of a glaring material that have no area or next to none.
Scene degenerateScene() {
  SceneBuilder b = stillLife();
  const uint32_t glaring = b.material(glm::vec3(0.9f), glm::vec3(100, 0, 0));
  const glm::vec3 p(0.1f, 0.7f, 0.2f), q(0.8f, 0.9f, -0.3f), up(0, 1e-7f, 0);
  b.quad(glaring, p, p, p, p);                     // points
  b.quad(glaring, p, q, q, p);                     // segments
  b.quad(glaring, p, glm::mix(p, q, 0.3f), q, p);  // three on a line, but for rounding
  b.quad(glaring, p, q, q + up, p + up);           // slivers an ulp or two wide
  return b.finish("degenerate");
}

void degenerateCase(CheckRun& run) {
  const auto plain = run.prepare(stillScene()), extra = run.prepare(degenerateScene());
  expectSame(run, "built", *extra, *plain);
  const auto loadedPlain = run.prepare(throughLoader(stillScene())),
             loadedExtra = run.prepare(throughLoader(degenerateScene()));
  expectSame(run, "loaded", *loadedExtra, *loadedPlain);
}

/// The floor, the lamp and the ball a second time.
Scene repeatedScene() {
  SceneBuilder b = stillLife();
  const uint32_t white = 0, lamp = 3, glossy = 4;
  b.quad(white, {-1, 0, 0.5f}, {1, 0, 0.5f}, {1, 0, -0.75f}, {-1, 0, -0.75f});
  b.quad(lamp, {-0.25f, 1.125f, -0.375f}, {0.25f, 1.125f, -0.375f}, {0.25f, 1.125f, 0}, {-0.25f, 1.125f, 0});
  b.sphere(glossy, {0.45f, 0.3f, -0.1f}, 0.25f, /*inward=*/false, 32);
  return b.finish("repeated");
}

/// What all facets emit, W.
double power(CheckRun& run, const Pipeline& pipeline) {
  const HostFacets f = hostFacets(run.context, pipeline.facets());
  double sum = 0;
  for (size_t i = 0; i < f.count(); ++i) sum += f.area[i] * double{f.emission[i].x};
  return sum;
}

void repeatedCase(CheckRun& run) {
  Settings settings = run.settings;
  for (const bool pixels : {false, true}) {
    if (pixels) settings.sample.emitters = EmitterLookup::pixels;
    const auto plain = run.prepare(stillScene(), settings), extra = run.prepare(repeatedScene(), settings);
    expectSame(run, pixels ? "emitters by pixels" : "built", *extra, *plain);
    run.near("power of all facets, W", power(run, *extra), power(run, *plain), 0);
  }
}

// ---- nan-input ----

constexpr uint32_t kNonFinite = 5, kZeroNormals = 7;

/// A scene whose first normals are zero, with glaring triangles whose vertices are not finite.
Scene damagedScene() {
  Scene scene = stillScene();
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  for (uint32_t i = 0; i < kZeroNormals; ++i) scene.normals[i] = glm::vec3(0);
  Material glaring;
  glaring.emission = glm::vec3(100, 0, 0);
  scene.draws.push_back(
      {static_cast<uint32_t>(scene.materials.size()), static_cast<uint32_t>(scene.indices.size()), 3 * kNonFinite});
  scene.materials.push_back(glaring);
  for (const glm::vec3& bad :
       {glm::vec3(nan, 0, 0), glm::vec3(0, inf, 0), glm::vec3(0, 0, -inf), glm::vec3(nan), glm::vec3(3e38f, 0, 0)})
    for (const glm::vec3& p : {glm::vec3(0.5f), bad, glm::vec3(-0.5f, 0.5f, 0)}) {
      scene.indices.push_back(static_cast<uint32_t>(scene.positions.size()));
      scene.positions.push_back(p);
      scene.normals.emplace_back(0, 0, 1);
    }
  return scene;
}

/// The number at the start of the warning that says `what`; 0: there is no such warning.
double reported(const Scene& scene, const std::string& what) {
  for (const std::string& warning : scene.warnings)
    if (const size_t at = warning.find(what); at != std::string::npos) {
      const size_t first = warning.find_last_not_of(" 0123456789", at - 1) + 1;
      return std::strtod(warning.c_str() + first, nullptr);
    }
  return 0;
}

/// Drawn once more by a node that makes a line of it: its triangles and damage are counted a second time.
Scene damagedFile() {
  return throughLoader(damagedScene(), glm::dvec3(0), {MeshNode{}, {.scale = {1, 0, 0}}});
}

void nanInputCase(CheckRun& run) {
  const Scene clean = stillScene(), damaged = damagedFile();
  run.near("triangles reported as non-finite", reported(damaged, " triangles with non-finite"), 2 * kNonFinite, 0);
  run.near("triangles reported as without area", reported(damaged, " triangles without area"), clean.triangleCount(),
           0);
  run.near("normals reported as zero", reported(damaged, " normals of length 0"), 2 * kZeroNormals, 0);
  run.near("triangles loaded", damaged.triangleCount(), clean.triangleCount(), 0);
  const auto got = run.prepare(damaged), want = run.prepare(throughLoader(clean));
  expectSame(run, "against the clean scene", *got, *want);
  for (const View view : {VIEW_LIT, VIEW_ALBEDO, VIEW_NORMAL, VIEW_IRRADIANCE})
    run.none(fmt::format("texels not finite: {}", views()[view].name), countNonFinite(picture(run, *got, view)));
}

// ---- flat and bar ----

/// What must hold for every scene: it has facets, and its light and pictures are finite.
std::unique_ptr<Pipeline> runs(CheckRun& run, const std::string& name, Scene scene) {
  auto pipeline = run.prepare(std::move(scene));
  run.require(name + ": has facets", pipeline->facets().count > 0);
  const Lighting& light = pipeline->lighting();
  uint64_t bad = 0;
  for (const Buffer* buffer : {&light.direct, &light.indirect, &light.radiosity})
    bad += countNonFinite(run.read(*pipeline, *buffer));
  run.none(name + ": light not finite", bad);
  run.none(name + ": pixels not finite", countNonFinite(picture(run, *pipeline, VIEW_LIT)));
  return pipeline;
}

/// A shining square, rho = .5, across `axis`, with a point light in front of it.
Scene flatScene(int axis) {
  SceneBuilder b;
  glm::vec3 u(0), v(0), n(0);
  u[(axis + 1) % 3] = 1, v[(axis + 2) % 3] = 1, n[axis] = 1;
  b.quad(b.material(glm::vec3(0.5f), glm::vec3(1)), -u - v, u - v, u + v, v - u, 8);
  b.point(glm::dvec3(n), 2);
  b.camera(glm::dvec3(3.0f * n + 0.5f * u), glm::dvec3(0));
  return b.finish("flat");
}
Scene flatAcrossY() {
  return flatScene(1);
}
void flatCase(CheckRun& run) {
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name = fmt::format("across {}", "xyz"[axis]);
    const auto pipeline = runs(run, name, flatScene(axis));
    run.near(name + ": inner voxels", pipeline->facets().grid.dims[axis] - 2.0, 1, 0);
    const Spread h = spread(run.read(*pipeline, pipeline->lighting().indirect));
    run.near(name + ": largest H", h.most, 0, 0);
    run.near(name + ": least M", spread(run.facets(*pipeline).emission).least, 1, 0);
  }
}

Scene bar(bool inward) {
  SceneBuilder b;
  const uint32_t m = b.material(glm::vec3(0.5f), glm::vec3(1));
  b.box(std::vector<uint32_t>(6, m), {-500, -0.5f, -0.5f}, {500, 0.5f, 0.5f}, inward);
  if (!inward) b.sun({-1, -2, -1}, 3);
  inward ? b.camera({480, 0, 0}, {0, 0, 0}) : b.camera({505, 2, 4}, {495, 0, 0});
  return b.finish("bar");
}
Scene barScene() {
  return bar(/*inward=*/false);
}

void barCase(CheckRun& run) {
  for (const bool inward : {false, true}) {
    const std::string name = inward ? "from inside" : "from outside";
    const auto pipeline = runs(run, name, bar(inward));
    run.info(fmt::format("{}: mean H, {} at infinite resolution", name, inward ? 2 : 0),
             spread(run.read(*pipeline, pipeline->lighting().indirect)).mean);
  }
}

}  // namespace

std::vector<CheckCase> inputCases() {
  return {
      {"degenerate", "points, segments and slivers in a still life", "as if absent", "bits equal", degenerateCase,
       degenerateScene},
      {.name = "repeated",
       .setup = "floor, lamp and ball of a still life a second time",
       .oracle = "as if absent",
       .mark = "bits equal",
       .run = repeatedCase,
       .scene = repeatedScene},
      {"nan-input", "a file with NaN and infinite vertices, zero normals, a singular node",
       "counted; the picture of the clean file", "exact", nanInputCase, damagedFile},
      {"flat", "a square across each axis", "one voxel thick, sees nothing of itself", "finite", flatCase, flatAcrossY,
       noLight},
      {"bar", "a box of 1000 x 1 x 1, from outside and inside", "runs", "finite", barCase, barScene},
  };
}

}  // namespace irad
