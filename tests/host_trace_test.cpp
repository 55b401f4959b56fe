// Rays that the host traces (gi/host_trace.h) against the kernel's, which know nothing of each other: Embree's tree and
// triangle test on one side, voxels and another test on the other.
#include "gi/host_trace.h"

#include <chrono>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "gi/host_facets.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/oracle/rays.h"
#include "gi/pipeline.h"
#include "gi/ray_kernel.h"
#include "gi/subsystems.h"
#include "shaders/shared/trace.h"
#include "tests/gi_fixture.h"

namespace irad::test::host_trace_suite {
namespace {

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

class HostTracing : public GiTest {
 protected:
  void SetUp() override {
    GiTest::SetUp();
    if (!canTraceOnHost()) GTEST_SKIP() << "no Embree in this build (IRAD_EMBREE)";
  }
  static Settings triangles(uint32_t resolution, uint32_t rays) {
    Settings s = at(resolution, rays);
    s.specular.mode = SpecularMode::off;
    return s;
  }
  std::vector<uint32_t> byHost(const World& w, uint32_t threads = 0) {
    const MatrixParams& params = w.settings.matrix.gpu;
    std::vector<uint32_t> hits(size_t{w.facets.count} * params.rays);
    makeHostTrace(context(), w.facets)->rows(params, 0, w.facets.count, hits, threads);
    return hits;
  }
  std::vector<uint32_t> byKernel(const World& w) {
    const MatrixParams& params = w.settings.matrix.gpu;
    const Buffer out(context().device, "hits", Subsystem::Matrix, 4ull * w.facets.count * params.rays);
    Frame frame = context().begin();
    traceRows(frame, rayKernel(w.facets, w.field, params), params, 0, w.facets.count, out);
    frame.submitAndWait();
    return downloadAs<uint32_t>(context(), out);
  }
  /// At most one ray in `fewest` differs, and these only where the decision is closer than fp32 can tell: which of two
  /// triangles is first, on which side of an edge or of a voxel's face the ray passes.
  void expectTiesAlone(const char* name, Scene scene, const Settings& settings, size_t fewest) {
    const World w = world(std::move(scene), settings);
    const MatrixParams& params = settings.matrix.gpu;
    double began = seconds();
    const std::vector<uint32_t> host = byHost(w);
    const double hostTook = seconds() - began;
    began = seconds();
    const std::vector<uint32_t> kernel = byKernel(w);
    const double kernelTook = seconds() - began;
    const oracle::Facets facets = oracleFacets(context(), w.facets);
    size_t differ = 0, met = 0, unexplained = 0;
    for (size_t i = 0; i < host.size(); ++i) {
      met += host[i] <= TRACE_LAST_FACET;
      if (host[i] == kernel[i]) continue;
      ++differ;
      const auto facet = static_cast<uint32_t>(i / params.rays);
      const oracle::Ray ray = oracle::facetRay(facets, facet, static_cast<uint32_t>(i % params.rays), params);
      const oracle::Hit hit = oracle::trace(facets, ray, params.hitRule);
      const glm::dvec3 within = glm::abs(glm::fract(ray.origin + hit.t * ray.direction + 0.5) - 0.5);
      const double margin = std::min({hit.margin, within.x, within.y, within.z});
      if (margin < 1e-3) continue;
      if (++unexplained <= 12)
        ADD_FAILURE() << name << ": facet " << facet << " ray " << i % params.rays << ": host " << host[i]
                      << ", kernel " << kernel[i] << ", oracle " << hit.facet << " at " << hit.t << ", margin "
                      << margin;
    }
    const double million = 1e-6 * static_cast<double>(host.size());
    fmt::print("{}: {} of {} rays differ; host {:.1f}, kernel {:.1f} million rays/s\n", name, differ, host.size(),
               million / hostTook, million / kernelTook);
    EXPECT_EQ(unexplained, 0u);
    EXPECT_LE(differ, host.size() / fewest);
    EXPECT_GT(met, host.size() / 3);
  }
};

/// Two rooms with a wall of `thickness` voxels between them, turned.
Scene twoRooms(float thickness) {
  SceneBuilder b;
  const glm::mat3 turn(glm::rotate(glm::mat4(1), 0.5f, glm::normalize(glm::vec3(2, 1, 3))));
  const uint32_t wall = b.material(glm::vec3(0.6f)), lamp = b.material(glm::vec3(0.5f), glm::vec3(5));
  b.box({lamp, wall, wall, wall, wall, wall}, {-12, -5, -5}, {12, 5, 5}, /*inward=*/true, turn);
  b.box({wall, wall, wall, wall, wall, wall}, {0.3f, -6, -6}, {0.3f + thickness, 6, 6}, /*inward=*/false, turn);
  return b.finish("two rooms");
}

/// A lamp that faces down close above a floor, with the same quad facing up in its place, before it or after it in the
/// file, cut along the same diagonal or the other; or none.
enum class Twin { none, same, other };
constexpr glm::vec3 kLamp[4] = {{-0.6f, 0.05f, 0.7f}, {0.8f, 0.05f, 0.7f}, {0.8f, 0.05f, -0.6f}, {-0.6f, 0.05f, -0.6f}};
Scene lampOverFloor(Twin twin, bool lampFirst, const glm::mat3& turn) {
  SceneBuilder b;
  const auto quad = [&](uint32_t material, const glm::vec3(&p)[4], bool up, uint32_t first) {
    glm::vec3 c[4];
    for (uint32_t i = 0; i < 4; ++i) c[i] = turn * p[up ? (first + i) % 4 : (first + 4 - i) % 4];
    b.quad(material, c[0], c[1], c[2], c[3]);
  };
  const glm::vec3 below[4] = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
  uint32_t lamp = lampFirst ? b.material(glm::vec3(0.2f), glm::vec3(3)) : 0;
  const uint32_t grey = b.material(glm::vec3(0.5f)), floor = b.material(glm::vec3(0.5f));
  if (!lampFirst) lamp = b.material(glm::vec3(0.2f), glm::vec3(3));
  quad(floor, below, true, 0);
  quad(lamp, kLamp, false, 0);
  if (twin != Twin::none) quad(grey, kLamp, true, twin == Twin::same ? 0 : 1);
  return b.finish("lamp over a floor");
}

/// A room with a sheet across it whose mask leaves stripes, two voxels wide at a resolution of 24.
Scene masked() {
  SceneBuilder b;
  const uint32_t wall = b.material(glm::vec3(0.5f)), sheet = b.material(glm::vec3(0.8f), glm::vec3(0), true);
  b.box({wall, wall, wall, wall, wall, wall}, glm::vec3(-1), glm::vec3(1), /*inward=*/true);
  b.quad(sheet, {-1, 0.02f, 1}, {1, 0.03f, 1}, {1, 0.05f, -1}, {-1, 0.04f, -1});
  Scene scene = b.finish("masked");
  SceneImage image{.name = "stripes", .width = 12, .height = 1, .srgb = true, .rgba = {}};
  for (int i = 0; i < 12; ++i)
    for (const uint8_t c : {255, 255, 255, i % 2 ? 0 : 255}) image.rgba.push_back(c);
  scene.images = {image};
  Material& m = scene.materials[sheet];
  m.alpha = AlphaMode::Mask;
  m.baseColorTexture.image = 0;
  m.baseColorTexture.sampler.linearMag = false;
  for (size_t i = 0; i < scene.positions.size(); ++i) scene.uv0[i] = {0.5f * scene.positions[i].x + 0.5f, 0.5f};
  return scene;
}

/// The same room with two sheets across it, one tilted to the other, that blend: alpha .3 (`thin`), and .7 by its
/// vertices.
Scene glazed(bool thin = true) {
  SceneBuilder b;
  const uint32_t wall = b.material(glm::vec3(0.5f)), pale = b.material(glm::vec3(0.8f), glm::vec3(0), true),
                 thick = b.material(glm::vec3(0.4f), glm::vec3(0), true);
  b.box({wall, wall, wall, wall, wall, wall}, glm::vec3(-1), glm::vec3(1), /*inward=*/true);
  if (thin) b.quad(pale, {-1, 0.02f, 1}, {1, 0.03f, 1}, {1, 0.05f, -1}, {-1, 0.04f, -1});
  b.quad(thick, {-1, 0.4f, 1}, {1, 0.5f, 1}, {1, 0.7f, -1}, {-1, 0.6f, -1});
  b.edit(pale).alpha = b.edit(thick).alpha = AlphaMode::Blend;
  b.edit(pale).baseColor.a = 0.3f;
  Scene scene = b.finish("glazed");
  for (const Draw& draw : scene.draws)
    for (uint32_t i = draw.firstIndex; draw.material == thick && i < draw.firstIndex + draw.indexCount; ++i)
      scene.colors[scene.indices[i]].a = 0.7f;
  return scene;
}

/// The lower sheet transmits .9 of a color instead.
Scene tinted(const glm::vec3& color) {
  Scene scene = glazed();
  Material& pale = scene.materials[1];
  pale.alpha = AlphaMode::Opaque;
  pale.baseColor = glm::vec4(color, 1);
  pale.lambertian = true;
  pale.transmission = 0.9f;
  return scene;
}

TEST_F(HostTracing, MeetsWhatTheKernelMeetsButForTies) {
  expectTiesAlone("furnished room", furnishedRoom(), triangles(24, 64), 20000);
  expectTiesAlone("thin wall", twoRooms(0.2f), triangles(24, 64), 20000);
  expectTiesAlone("masked", masked(), triangles(24, 64), 20000);
  expectTiesAlone("glazed", glazed(), triangles(24, 64), 20000);
  expectTiesAlone("tinted", tinted({0.9f, 0.5f, 0.2f}), triangles(24, 64), 20000);
  expectTiesAlone("box.glb", loadScene(sourceFolder() / "assets/box.glb"), triangles(40, 32), 20000);
}

TEST_F(HostTracing, OfTwoFacesInOnePlaneTheSideThatShowsIsMet) {
  // F M of the floor, by facets, as a closed form says; and of the ways down to it none ends in the dark.
  for (const float angle : {0.0f, 0.7f})
    for (const uint32_t resolution : {24u, 43u})
      for (const Twin twin : {Twin::none, Twin::same, Twin::other})
        for (const bool lampFirst : {false, true}) {
          const glm::mat3 turn(glm::rotate(glm::mat4(1), angle, glm::normalize(glm::vec3(3, -1, 2))));
          const std::string name = fmt::format("{} voxels, turned by {}, twin {}, {}", resolution, angle,
                                               static_cast<int>(twin), lampFirst ? "lamp first" : "lamp last");
          const World w = world(lampOverFloor(twin, lampFirst, turn), triangles(resolution, 64));
          const MatrixParams& params = w.settings.matrix.gpu;
          const std::vector<uint32_t> host = byHost(w), kernel = byKernel(w);
          const HostFacets f = hostFacets(context(), w.facets);
          const oracle::Facets list = oracleFacets(context(), w.facets);
          std::array<glm::dvec3, 4> lamp;
          for (int i = 0; i < 4; ++i) lamp[i] = turn * kLamp[3 - i];
          size_t differ = 0, byOracle = 0, backs = 0;
          double found = 0, known = 0;
          for (uint32_t i = 0; i < f.count(); ++i) {
            const bool floor =
                glm::dot(f.normal[i], glm::dvec3(turn[1])) > 0.9 && glm::dot(f.position[i], glm::dvec3(turn[1])) < 0.03;
            const uint32_t rays = oracle::raysOf(list, i, params);
            double light = 0, valid = 0;
            for (uint32_t k = 0; k < rays; ++k) {
              const uint32_t met = kernel[size_t{i} * params.rays + k];
              const oracle::Hit hit = oracle::trace(list, oracle::facetRay(list, i, k, params), params.hitRule);
              differ += met != host[size_t{i} * params.rays + k];
              byOracle += met != hit.facet;
              if (!floor) continue;
              backs += met == TRACE_BLOCKED;
              valid += met != TRACE_INVALID;
              if (met <= TRACE_LAST_FACET) light += double{f.emission[met].x};
            }
            if (!floor) continue;
            found += f.area[i] * light / valid;
            // The middle of all that a facet's surfels see.
            for (uint32_t k = 0; k < FACET_SURFELS; ++k)
              known += f.area[i] * 3 / FACET_SURFELS *
                       formFactorPolygon(f.surfels[size_t{i} * FACET_SURFELS + k], f.normal[i], lamp);
          }
          const size_t all = host.size();
          fmt::print("{}: F M {:.4f} of {:.4f}; {} backs; of {} rays differ {}, from the oracle's {}\n", name, found,
                     known, backs, all, differ, byOracle);
          EXPECT_NEAR(found / known, 1, 0.01) << name;
          EXPECT_EQ(backs, 0u) << name;
          EXPECT_LE(differ, all / 10000) << name;
          EXPECT_LE(byOracle, all / 10000) << name;
        }
}

TEST_F(HostTracing, HolesLetRaysThroughFromEverySide) {
  // From the floor half of what would meet the sheet passes it, by voxels, whichever way it goes.
  const World w = world(masked(), triangles(24, 128));
  const std::vector<uint32_t> hits = byHost(w), kernel = byKernel(w);
  const HostFacets f = hostFacets(context(), w.facets);
  const auto passed = [&](const std::vector<uint32_t>& met) {
    double all = 0, above = 0;
    for (size_t i = 0; i < met.size(); ++i) {
      const glm::dvec3 &from = f.position[i / 128], &normal = f.normal[i / 128];
      if (from.y > -0.99 || normal.y < 0.9 || met[i] > TRACE_LAST_FACET) continue;
      const glm::dvec3& to = f.position[met[i]];
      if (to.y < 0) continue;
      ++all;
      above += to.y > 0.1;
    }
    return above / all;
  };
  fmt::print("through the stripes: {:.4f}\n", passed(hits));
  EXPECT_NEAR(passed(hits), 0.5, 0.05);
  EXPECT_NEAR(passed(kernel), passed(hits), 1e-3);
}

TEST_F(HostTracing, GlassLetsItsShareThrough) {
  // Of the floor's rays that come above the lower sheet, 1 - alpha still do with it there.
  const auto above = [&](const World& w, const std::vector<uint32_t>& met) {
    const HostFacets f = hostFacets(context(), w.facets);
    double count = 0;
    for (size_t i = 0; i < met.size(); ++i)
      count += f.position[i / 128].y < -0.99 && f.normal[i / 128].y > 0.9 && met[i] <= TRACE_LAST_FACET &&
               f.position[met[i]].y > 0.1;
    return count;
  };
  const World open = world(glazed(/*thin=*/false), triangles(24, 128)), w = world(glazed(), triangles(24, 128));
  const double all = above(open, byHost(open)), host = above(w, byHost(w)) / all, kernel = above(w, byKernel(w)) / all;
  fmt::print("through alpha .3: {:.4f} of {:.0f}\n", host, all);
  EXPECT_NEAR(host, 0.7, 0.01);
  EXPECT_NEAR(kernel, host, 1e-3);
}

TEST_F(HostTracing, PanesLetTheirShareOfEachChannelThrough) {
  // Of the floor's rays that come above the lower sheet, those that keep a channel are .9 of the pane's color of it.
  constexpr uint32_t kRays = 128, kShift = TINT_SHIFT_FRAMES;
  const glm::dvec3 color(0.9, 0.5, 0.2);
  const World open = world(glazed(/*thin=*/false), triangles(24, kRays)),
              w = world(tinted(color), triangles(24, kRays));
  const auto above = [&](const World& in, const std::vector<uint32_t>& met, uint32_t channel) {
    const HostFacets f = hostFacets(context(), in.facets);
    double count = 0;
    for (size_t i = 0; i < met.size(); ++i) {
      if (f.position[i / kRays].y > -0.99 || f.normal[i / kRays].y < 0.9 || met[i] > TRACE_LAST_FACET) continue;
      const bool kept = (met[i] >> kShift >> channel & 1) == 0;
      count += kept && f.position[met[i] & ((1u << kShift) - 1)].y > 0.1;
    }
    return count;
  };
  std::vector<uint32_t> host(uint64_t{w.facets.count} * kRays);
  makeHostTrace(context(), w.facets)->rows(w.settings.matrix.gpu, 0, w.facets.count, host, 0, false, kShift);
  const Buffer hits(context().device, "hits", Subsystem::Staging, 4 * host.size());
  RayKernel kernel = rayKernel(w.facets, w.field, w.settings.matrix.gpu);
  kernel.tintShift = kShift;
  Frame frame = context().begin();
  traceRows(frame, kernel, w.settings.matrix.gpu, 0, w.facets.count, hits);
  frame.submitAndWait();
  const std::vector<uint32_t> device = downloadAs<uint32_t>(context(), hits);
  const double all = above(open, byHost(open), 0);
  for (uint32_t c = 0; c < 3; ++c) {
    const double share = above(w, host, c) / all, byDevice = above(w, device, c) / all;
    fmt::print("channel {}: {:.4f} of {:.4f}\n", c, share, 0.9 * color[c]);
    EXPECT_NEAR(share, 0.9 * color[c], 0.01);
    EXPECT_NEAR(byDevice, share, 1e-3);
  }
  // The reflected rest, over what is met of the pane, is its facets' albedo.
  const HostFacets f = hostFacets(context(), w.facets);
  size_t seen = 0;
  for (size_t i = 0; i < f.count(); ++i) {
    if (std::abs(f.position[i].y - 0.035) > 0.02 || std::abs(f.normal[i].y) < 0.9) continue;
    ++seen;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(f.albedo[i][c], 0.1 * color[c] / (1 - 0.9 * color.x), 1e-4);
  }
  EXPECT_GT(seen, 100u);
}

TEST_F(HostTracing, TheSameHitsFromAnyNumberOfThreads) {
  const World w = world(furnishedRoom(), triangles(20, 24));
  const std::vector<uint32_t> one = byHost(w, 1);
  EXPECT_EQ(one, byHost(w, 2));
  EXPECT_EQ(one, byHost(w, 5));
  // And of any rows by themselves.
  const uint32_t first = w.facets.count / 3, rows = 37;
  std::vector<uint32_t> some(rows * 24);
  makeHostTrace(context(), w.facets)->rows(w.settings.matrix.gpu, first, rows, some);
  EXPECT_TRUE(std::equal(some.begin(), some.end(), one.begin() + first * 24));
}

TEST_F(HostTracing, MatricesOfCpuDevicesAreTheHosts) {
  if (!context().device.isCpu) GTEST_SKIP() << "of CPU devices";
  const World w = world(twoRooms(0.2f), triangles(20, 32));
  context().timings.reset();
  const FormFactors matrix = buildMatrix(context(), w.facets, w.field, w.settings);
  context().timings.endFrame(0, /*setup=*/true, 0);
  const std::vector<uint32_t> hits = byHost(w);
  uint32_t first = 0;
  for (const HostRow& row : hostRows(context(), matrix)) {
    std::vector<uint32_t> met(hits.begin() + first, hits.begin() + first + 32), stored;
    std::erase_if(met, [](uint32_t hit) { return hit > TRACE_LAST_FACET; });
    std::ranges::sort(met);
    for (size_t i = 0; i < row.columns.size(); ++i) stored.insert(stored.end(), row.hits[i], row.columns[i]);
    ASSERT_EQ(stored, met) << first / 32;
    first += 32;
  }
  EXPECT_EQ(first, hits.size());
  ASSERT_EQ(context().timings.frames().size(), 1u);
  const FrameSample& sample = context().timings.frames().front();
  ASSERT_EQ(sample.stages.size(), 1u);
  EXPECT_EQ(sample.stages[0].first, "GI BuildMatrix");
  EXPECT_GT(sample.stages[0].second, 0);
  // Cancelled between chunks, as the kernel's.
  float last = 0;
  EXPECT_THROW(buildMatrix(context(), w.facets, w.field, w.settings,
                           [&](float done) {
                             last = done;
                             return done == 0;
                           }),
               WorkError);
  EXPECT_GT(last, 0);
}

TEST_F(HostTracing, TooLittleMemoryIsSaidInWords) {
  const World w = world(furnishedRoom(), triangles(12, 8));
  for (const uint64_t kib : {0u, 4u, 20u, 40u}) {
    try {
      makeHostTrace(context(), w.facets, kib << 10);
      FAIL() << kib << " KiB cannot hold a tree of " << w.scene->triangleCount() << " triangles";
    } catch (const DeviceError& e) {
      EXPECT_NE(std::string(e.what()).find(fmt::format("the {} KiB that are free", kib)), std::string::npos)
          << e.what();
    }
  }
  EXPECT_NE(makeHostTrace(context(), w.facets, 64 << 20), nullptr);
}

}  // namespace
}  // namespace irad::test::host_trace_suite
