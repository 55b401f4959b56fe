// Direct light on the facets against closed forms (docs/method.md 6, T 5.7).
#include "gi/gather.h"
#include "gi/host_facets.h"
#include "gi/host_trace.h"
#include "gi/lighting.h"
#include "gi/oracle/rays.h"
#include "gi/shadow_needs.h"
#include "renderer/shadow.h"
#include "tests/gi_fixture.h"

namespace irad::test::gather_suite {
namespace {

class Gather : public GiTest {
 protected:
  /// D of every facet, and where it lies; local.
  struct Result {
    std::vector<glm::vec4> direct;
    std::vector<glm::dvec3> position, normal;
    std::vector<glm::dvec3> surfels;  ///< FACET_SURFELS of each
  };
  std::vector<glm::vec4> directOf(const World& w, bool onHost = true) {
    // The lights' points are filled in with the maps.
    const ShadowMaps shadows =
        drawShadows(context(), *w.device, w.settings.light.shadowResolution, shadowNeeds(w.settings));
    Lighting light = makeLighting(context(), w.facets, w.settings);
    Frame frame = context().begin();
    gather(frame, *w.device, shadows, w.facets, w.field, light, w.settings, onHost);
    frame.submitAndWait();
    return downloadAs<glm::vec4>(context(), light.direct);
  }
  Result run(Scene scene, uint32_t resolution) {
    const World w = world(std::move(scene), at(resolution, 64));
    Result r;
    r.direct = directOf(w);
    const HostFacets host = hostFacets(context(), w.facets);
    r.position = host.position;
    r.normal = host.normal;
    const oracle::Facets list = oracleFacets(context(), w.facets);
    for (uint32_t i = 0; i < w.facets.count; ++i)
      for (uint32_t k = 0; k < FACET_SURFELS; ++k)
        r.surfels.emplace_back(glm::dvec3(w.facets.grid.origin) +
                               double{w.facets.grid.edge} * list.point(FACET_SURFELS * i + k));
    return r;
  }
  static void floor(SceneBuilder& b, float half) {
    b.quad(b.material(glm::vec3(0.5f)), {-half, 0, half}, {half, 0, half}, {half, 0, -half}, {-half, 0, -half});
  }
};

TEST_F(Gather, SunOnAPlane) {
  SceneBuilder b;
  floor(b, 1);
  b.sun({1, -1, 0}, 3.0f);
  const Result r = run(b.finish("sun"), 32);
  ASSERT_GE(r.direct.size(), 32u * 32u);
  for (size_t i = 0; i < r.direct.size(); ++i)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(r.direct[i][c], 3 * std::sqrt(0.5), 0.005 * 3 * std::sqrt(0.5)) << i;
}

TEST_F(Gather, PointLightFallsWithTheSquare) {
  SceneBuilder b;
  floor(b, 1);
  b.point({0.2, 0.7, -0.1}, 5.0f);
  const Result r = run(b.finish("point"), 64);
  double worst = 0;
  for (size_t i = 0; i < r.direct.size(); ++i) {
    double expected = 0;
    for (uint32_t k = 0; k < FACET_SURFELS; ++k) {
      const glm::dvec3 d = glm::dvec3(0.2, 0.7, -0.1) - r.surfels[FACET_SURFELS * i + k];
      expected += 5 * glm::dot(d, r.normal[i]) / std::pow(glm::length(d), 3) / FACET_SURFELS;
    }
    worst = std::max(worst, std::abs(r.direct[i].x / expected - 1));
  }
  fmt::print("point light: worst facet {:.3f} % off\n", 100 * worst);
  EXPECT_LT(worst, 1e-4);
}

TEST_F(Gather, BacksAndShadowsStayDark) {
  // A square casts its shadow on the floor below; the sun shines straight down. Facets that face down get nothing.
  SceneBuilder b;
  floor(b, 1);
  const uint32_t two = b.material(glm::vec3(0.5f), glm::vec3(0.0f), /*doubleSided=*/true);
  b.quad(two, {-0.5f, 0.5f, 0.5f}, {0.5f, 0.5f, 0.5f}, {0.5f, 0.5f, -0.5f}, {-0.5f, 0.5f, -0.5f});
  b.sun({0, -1, 0}, 2.0f);
  const Result r = run(b.finish("shadow"), 64);
  const double voxel = 2.0 / 64;
  int lit = 0, shaded = 0, backs = 0;
  for (size_t i = 0; i < r.direct.size(); ++i) {
    const glm::dvec3 p = r.position[i];
    const double edge = std::max(std::abs(p.x), std::abs(p.z));
    if (r.normal[i].y < 0) {
      ++backs;
      EXPECT_EQ(r.direct[i].x, 0.0f);
    } else if (p.y > 0.25 || edge > 0.5 + 2 * voxel) {
      ++lit;
      EXPECT_NEAR(r.direct[i].x, 2.0f, 0.01f) << p.x << ' ' << p.y << ' ' << p.z;
    } else if (edge < 0.5 - 2 * voxel) {
      ++shaded;
      EXPECT_EQ(r.direct[i].x, 0.0f) << p.x << ' ' << p.y << ' ' << p.z;
    }
  }
  EXPECT_GT(lit, 3000);
  EXPECT_GT(shaded, 700);
  EXPECT_GT(backs, 700);
}

TEST_F(Gather, TheHostFindsWhatTheKernelFinds) {
  if (!canTraceOnHost()) GTEST_SKIP() << "built without IRAD_EMBREE";
  if (!context().device.isCpu) GTEST_SKIP() << "the kernel gathers on GPUs";
  // Lights of every kind, with a size and without, past a ball, a veil and a pane that tints.
  SceneBuilder b;
  const uint32_t m = b.material(glm::vec3(0.7f)), pane = b.material(glm::vec3(0.9f, 0.5f, 0.2f)),
                 veil = b.material(glm::vec3(0.6f));
  floor(b, 1);
  b.sphere(m, glm::vec3(-0.4f, 0.3f, -0.2f), 0.25f, /*inward=*/false, 12);
  b.quad(pane, {-1, 0.62f, 1}, {0.2f, 0.63f, 1}, {0.2f, 0.65f, -1}, {-1, 0.64f, -1});
  b.quad(veil, {0, 0.31f, 1}, {1, 0.32f, 1}, {1, 0.35f, -1}, {0, 0.34f, -1});
  b.edit(pane).transmission = 0.9f;
  b.edit(veil).alpha = AlphaMode::Blend;
  b.edit(veil).baseColor.a = 0.4f;
  b.sun({1, -1, 0.3f}, 3);
  b.sun({1, -2, 0.3f}, 3);
  for (int k = 0; k < 4; ++k) b.point({0.2 - 0.3 * k, 0.9, 0.1 * k}, 1);
  Scene scene = b.finish("lights");
  scene.lights[1].angle = 4;
  scene.lights[3].radius = 0.1f;
  for (int k = 4; k < 6; ++k) {
    scene.lights[k].type = LightType::Spot;
    scene.lights[k].innerCos = 0.9f;
    scene.lights[k].range = 3;
  }
  scene.lights[5].radius = 0.2f;
  const World w = world(std::move(scene), at(24, 64));
  const std::vector<glm::vec4> host = directOf(w), kernel = directOf(w, /*onHost=*/false);
  EXPECT_EQ(host, directOf(w)) << "the same bits twice";
  size_t differ = 0;
  glm::dvec3 byHost(0), byKernel(0);
  for (size_t i = 0; i < host.size(); ++i) {
    byHost += glm::dvec3(host[i]);
    byKernel += glm::dvec3(kernel[i]);
    // One point of a light more or less changes more than this.
    differ += glm::length(glm::vec3(host[i] - kernel[i])) > 1e-4f * glm::length(glm::vec3(kernel[i])) + 1e-6f;
  }
  fmt::print("D of {} of {} facets differs between host and kernel; sums {:.6f} {:.6f} {:.6f} times\n", differ,
             host.size(), byHost.x / byKernel.x, byHost.y / byKernel.y, byHost.z / byKernel.z);
  EXPECT_LT(differ, host.size() / 50) << "ties alone";
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(byHost[c] / byKernel[c], 1, 1e-4) << c;
  EXPECT_LT(byHost.z / byHost.x, 0.95) << "the pane tints";
}

}  // namespace
}  // namespace irad::test::gather_suite
