// The blur of H between linked facets (docs/method.md 7): how far it goes, and the noise of a row's rays that says so.
#include <algorithm>
#include <cmath>
#include <string>

#include "gi/facets.h"
#include "gi/host_facets.h"
#include "gi/host_matrix.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/pipeline.h"
#include "gi/row_noise.h"
#include "gi/scatter.h"
#include "gi/subsystems.h"
#include "renderer/scene/scene.h"
#include "shaders/shared/solve.h"
#include "shaders/shared/surface.h"
#include "tests/gi_fixture.h"

namespace irad::test::blur_suite {
namespace {

using Values = std::vector<glm::dvec3>;

/// A room of 2 x 2 x 2 with a lamp for its ceiling, and a board .1 above the floor: H of the floor has an edge of less
/// than a voxel under the board's rim.
Scene boardRoom(float albedo = 0.5f) {
  SceneBuilder b;
  const uint32_t wall = b.material(glm::vec3(albedo)), lamp = b.material(glm::vec3(albedo), glm::vec3(2));
  b.box({wall, wall, wall, lamp, wall, wall}, glm::vec3(-1), glm::vec3(1), /*inward=*/true);
  b.box(std::vector<uint32_t>(6, wall), {-0.97f, -0.9f, -0.97f}, {0.11f, -0.85f, 0.97f}, /*inward=*/false);
  return b.finish("board");
}
/// Light that comes by reflection alone.
Scene litFurniture() {
  Scene scene = furnishedRoom();
  scene.lights = {{.type = LightType::Point, .position = scene.origin, .intensity = 1}};
  return scene;
}
/// A floor under the sky, with a ball on it.
Scene openFloor() {
  SceneBuilder b;
  const uint32_t wall = b.material(glm::vec3(0.5f), glm::vec3(0), /*doubleSided=*/true);
  b.quad(wall, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
  b.sphere(wall, {0.1f, 0.4f, 0}, 0.4f, /*inward=*/false, 24);
  return b.finish("open floor");
}

class Blur : public GiTest {
 protected:
  static Settings settings(uint32_t resolution, uint32_t rays, SampleFilter filter = SampleFilter::blur) {
    Settings s = at(resolution, rays);
    s.specular.mode = SpecularMode::off;
    s.matrix.emitterSampling = EffectMode::off;
    s.light.shadowResolution = 256;
    s.effects.blur = EffectMode::on;
    s.sample.gpu.filter_ = filter;
    return s;
  }
  Values values(const Pipeline& p, const Buffer& buffer) {
    const std::vector<glm::vec3> v = perFacet(context(), p.facets(), buffer);
    return {v.begin(), v.end()};
  }
  /// The square of what rowNoise() says, W^2/m^4.
  std::vector<double> told(const Pipeline& p) {
    const uint64_t bytes = 16ull * p.facets().count;
    const Buffer squares(context().device, "squares", Subsystem::Solver, bytes),
        error(context().device, "error", Subsystem::Solver, bytes);
    Frame frame = context().begin();
    rowNoise(frame, p.facets(), p.matrix(), p.obeyed().solver, p.lighting(), squares, error);
    frame.submitAndWait();
    std::vector<double> out;
    for (const glm::dvec3& e : values(p, error)) out.push_back(glm::dot(e, e));
    return out;
  }
};

TEST_F(Blur, TheNoiseIsTheVarianceOfARowsRaysOverTheirNumber) {
  // From the matrix's rows in double precision; of an even sky what has not met a facet has met the sky.
  const float sky = 0.7f;
  struct Case {
    const char* name;
    Scene scene;
    EffectMode sampled;
    bool sky;
  };
  Case cases[] = {{"board", boardRoom(), EffectMode::off, false},
                  {"mixed room", mixedRoom(), EffectMode::on, false},
                  {"open floor", openFloor(), EffectMode::off, true}};
  for (Case& c : cases) {
    SCOPED_TRACE(c.name);
    Settings s = settings(12, 48);
    s.matrix.emitterSampling = c.sampled;
    s.solver.tolerance = 1e-6f;  // H is F B, up to this
    if (c.sky) s.sky.source = SkySource::constant, s.sky.intensity = sky;
    Pipeline p(context(), std::move(c.scene), s);
    p.prepare();
    ASSERT_EQ(static_cast<bool>(p.lighting().correction), c.sampled == EffectMode::on);
    const HostFacets f = hostFacets(context(), p.facets());
    const Values b = values(p, p.lighting().radiosity);
    const std::vector<HostRow> rows = hostRows(context(), p.matrix());
    const std::vector<double> noise = told(p);
    const auto emitted = p.lighting().emitted ? downloadAs<glm::vec4>(context(), p.lighting().emitted)
                                              : std::vector<glm::vec4>(rows.size());
    double largest = 0, off = 0;
    for (size_t i = 0; i < rows.size(); ++i) {
      glm::dvec3 first(0), second(0);
      const auto add = [&](const glm::dvec3& brought, double share) {
        first += share * brought, second += share * brought * brought;
      };
      for (size_t k = 0; k < rows[i].columns.size(); ++k) {
        const uint32_t j = rows[i].columns[k];
        const glm::dvec3 exitance = c.sampled == EffectMode::on ? glm::dvec3(f.emission[j]) : glm::dvec3(0);
        add(b[j] - exitance, rows[i].hits[k] * double{rows[i].weight});
      }
      if (c.sky) add(glm::dvec3(M_PI * sky), 1 - rows[i].sum());
      const glm::dvec3 variance = second - first * first;
      // Samples of emitters tell their own; that they do is for the spread over seeds to say.
      const double expected =
          double{ROW_NOISE_SHARE} * (rows[i].weight * (variance.x + variance.y + variance.z) + double{emitted[i].w});
      largest = std::max(largest, expected);
      off = std::max(off, std::abs(noise[i] - expected));
    }
    EXPECT_GT(largest, 0);
    EXPECT_LT(off, 1e-3 * largest);
  }
}

/// What pictures are drawn from, and what they could be.
struct Shown {
  Values h, shown, mean;                 ///< H, as it is shown, and averaged over the links all the way
  Values emitted, shownEmitted, meanOf;  ///< F M likewise
};

TEST_F(Blur, TakesOutNoiseAndLeavesEdges) {
  const auto show = [&](Settings s) {
    s.solver.tolerance = 1e-5f;
    Pipeline p(context(), boardRoom(), s);
    p.prepare();
    const Lighting& light = p.lighting();
    Shown out{.h = values(p, light.indirect),
              .shown = values(p, light.shaded()),
              .emitted = values(p, light.emitted),
              .shownEmitted = values(p, light.shadedEmitted())};
    // Noise that nobody knows: the mean.
    Lighting unknown = makeLighting(context(), p.facets(), s);
    Frame frame = context().begin();
    frame.pass("test").copy(light.indirect, unknown.indirect, light.indirect.bytes);
    frame.pass("test").copy(light.emitted, unknown.emitted, light.emitted.bytes);
    scatter(frame, p.facets(), FormFactors{}, unknown, s);
    frame.submitAndWait();
    out.mean = values(p, unknown.shaded());
    out.meanOf = values(p, unknown.shadedEmitted());
    return out;
  };
  constexpr uint32_t kVoxels = 12;
  Settings exact = settings(kVoxels, 2048, SampleFilter::linear);
  exact.matrix.gpu.seed = 1;
  exact.solver.tolerance = 1e-5f;
  Pipeline reference(context(), boardRoom(), exact);
  reference.prepare();
  const Values truth = values(reference, reference.lighting().indirect);
  const std::vector<double> area = hostFacets(context(), reference.facets()).area;
  const auto error = [&](const Values& v) {
    double sum = 0;
    for (size_t i = 0; i < v.size(); ++i) sum += area[i] * glm::dot(v[i] - truth[i], v[i] - truth[i]);
    return sum;
  };
  for (const bool frames : {false, true}) {
    const auto with = [&](uint32_t rays, uint32_t framesOrRows) {
      Settings s = settings(kVoxels, frames ? rays : rays * framesOrRows);
      if (frames) s.solver.method = SolverMethod::bruteForce, s.solver.frames = framesOrRows;
      return show(s);
    };
    const Shown noisy = with(8, 8), fine = with(16, 64);
    for (const auto& [name, shown] : {std::pair{"few", &noisy}, {"many", &fine}}) {
      fmt::print("{} rays, {}: squared error of the mean {:.3f}, as shown {:.3f} of that of H\n", name,
                 frames ? "frames" : "matrix", error(shown->mean) / error(shown->h),
                 error(shown->shown) / error(shown->h));
      // Between H and the mean, and F M as far as H.
      double least = 1, most = 0;
      for (size_t i = 0; i < shown->h.size(); ++i) {
        const glm::dvec3 way = shown->h[i] - shown->mean[i];
        if (glm::length(way) < 1e-3) continue;
        const double keep = glm::dot(shown->shown[i] - shown->mean[i], way) / glm::dot(way, way);
        least = std::min(least, keep), most = std::max(most, keep);
        const glm::dvec3 expected = glm::mix(shown->meanOf[i], shown->emitted[i], keep);
        EXPECT_LT(glm::length(shown->shownEmitted[i] - expected), 1e-2 * glm::length(expected) + 1e-3) << i;
      }
      EXPECT_GT(least, -1e-3);
      EXPECT_LT(most, 1 + 1e-3);
      EXPECT_GT(most - least, 0.5);
    }
    EXPECT_LT(error(noisy.shown), 0.8 * error(noisy.h));                   // with keep = 1 it would be error(noisy.h)
    EXPECT_GT(error(fine.mean), 3 * error(fine.h)) << "there is no edge";  // what keep = 0 would show
    EXPECT_LT(error(fine.shown), 1.2 * error(fine.h));
  }
}

/// The variance of H over seeds, as a share of that of the mean of independent rays.
class BlurNoise : public Blur {
 protected:
  struct Shares {
    double all, calm, loud;  ///< of all facets, and of the halves with less and more noise by rowNoise()
  };
  static Settings linear(uint32_t voxels, uint32_t rays) { return settings(voxels, rays, SampleFilter::linear); }
  /// `toldBy`: rays of the matrix that says what one ray's variance is.
  Shares shares(const std::string& name, const Scene& scene, Settings s, uint32_t toldBy, uint32_t seeds = 16) {
    const uint32_t rays = s.matrix.gpu.rays;
    s.matrix.gpu.rays = toldBy;
    Pipeline p(context(), scene, s);
    p.prepare();
    std::vector<double> noise = told(p);
    const std::vector<double> area = hostFacets(context(), p.facets()).area;
    const std::vector<HostRow> rows = hostRows(context(), p.matrix());
    for (size_t i = 0; i < noise.size(); ++i)
      noise[i] /= double{ROW_NOISE_SHARE} * rows[i].weight * facetRays(static_cast<float>(area[i]), rays);
    s.matrix.gpu.rays = rays;
    std::vector<Values> runs;
    for (uint32_t seed = 0; seed < seeds; ++seed) {
      s.matrix.gpu.seed = 100 + seed;
      p.set(s);
      p.prepare();
      runs.push_back(values(p, p.lighting().indirect));
    }
    std::vector<double> sorted = noise;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<ptrdiff_t>(sorted.size() / 2), sorted.end());
    const double middle = sorted[sorted.size() / 2];
    double seen[2] = {}, expected[2] = {}, power = 0, whole = 0;
    for (size_t i = 0; i < noise.size(); ++i) {
      glm::dvec3 mean(0);
      double squares = 0;
      for (const Values& run : runs) mean += run[i] / static_cast<double>(seeds);
      for (const Values& run : runs) squares += glm::dot(run[i] - mean, run[i] - mean) / (seeds - 1);
      const bool loud = noise[i] >= middle;
      seen[loud] += area[i] * squares;
      expected[loud] += area[i] * noise[i];
      power += area[i] * glm::length(mean), whole += area[i];
    }
    const Shares share{(seen[0] + seen[1]) / (expected[0] + expected[1]), seen[0] / expected[0], seen[1] / expected[1]};
    fmt::print(
        "{}, {} voxels, {} rays: spread over {} seeds {:.2g} of the mean; variance {:.3f} of independent rays', "
        "{:.3f} where calm, {:.3f} where loud\n",
        name, s.voxel.resolution, rays, seeds, std::sqrt((seen[0] + seen[1]) / whole) / (power / whole), share.all,
        share.calm, share.loud);
    return share;
  }
};

TEST_F(BlurNoise, IsTheSpreadOverSeeds) {
  // One ray is stratified with nothing: the law itself. Hardly any light comes twice, whose noise is not the row's own.
  EXPECT_NEAR(shares("dark board", boardRoom(0.02f), linear(10, 1), 1024).all, 1, 0.1);
  // Rays that are spread evenly do better: the more so, the smoother what they see.
  Settings sky = linear(10, 32), sampled = linear(10, 32);
  sampled.matrix.emitterSampling = EffectMode::on;
  sky.sky.source = SkySource::constant;
  for (const Shares& share :
       {shares("board", boardRoom(), linear(10, 32), 512), shares("furniture", litFurniture(), linear(10, 32), 512),
        shares("open floor", openFloor(), sky, 512), shares("lamp by samples", mixedRoom(), sampled, 32)})
    for (const double x : {share.all, share.loud}) {  // where a row is calm the noise of B is more than its own
      EXPECT_GT(x, 0.1);
      EXPECT_LT(x, 0.7);
    }
}

TEST_F(BlurNoise, OfRealScenesIsTheSpreadAtMost) {
  const auto scenes = sharedScenes();
  if (!scenes) GTEST_SKIP() << "real scenes lie beside the project, in ../shared/scenes, which is absent";
  for (const char* name : {"cornell/mcguire_original", "real/living_room", "real/room", "real/zdm2"}) {
    const Scene scene = loadScene(*scenes / (std::string(name) + ".glb"));
    for (const uint32_t rays : {32u, 128u})
      EXPECT_LT(shares(name, scene, linear(48, rays), 512, /*seeds=*/4).all, 1) << name;
  }
}

}  // namespace
}  // namespace irad::test::blur_suite
