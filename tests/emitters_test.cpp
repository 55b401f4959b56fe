// The first gather by samples of the emitters, against closed forms and against the rays (METHOD section 5, HARD_CASES
// tiny-emitter).
#include <array>
#include <numbers>

#include "tests/gi_fixture.h"

namespace irad::test {
namespace {

class EmitterSamples : public GiTest {
 protected:
  std::vector<glm::vec4> values(const Buffer& buffer) { return downloadAs<glm::vec4>(context(), buffer); }
};

/// Share of the hemisphere about `normal` at `p`, cosine-weighted, that a polygon fills (Lambert's formula).
double polygonFactor(const glm::dvec3& p, const glm::dvec3& normal, const std::array<glm::dvec3, 4>& corners) {
  double sum = 0;
  for (int i = 0; i < 4; ++i) {
    const glm::dvec3 a = glm::normalize(corners[i] - p), b = glm::normalize(corners[(i + 1) % 4] - p);
    const glm::dvec3 c = glm::cross(a, b);
    sum += glm::dot(glm::normalize(c), normal) * std::atan2(glm::length(c), glm::dot(a, b));
  }
  return std::abs(sum) / (2 * std::numbers::pi);
}

TEST_F(EmitterSamples, TinyEmitterIsSampled) {
  // A lamp of 2 x 2 voxels in a dark room, half a room above the floor: F is about 1e-3 there, an eighth of a ray.
  Settings settings = at(64, 128);
  const Grid grid = makeGrid(glm::vec3(-1), glm::vec3(1), settings.voxel.resolution);
  const auto corner = [&](double x, double z) {
    return glm::dvec3(grid.origin) + double{grid.edge} * glm::dvec3(x, 33.5, z);
  };
  const auto square = [&](double low, double high) {
    return std::array{corner(low, low), corner(high, low), corner(high, high), corner(low, high)};
  };
  const auto lamp = square(31.01, 32.99), faces = square(31, 33);  // a facet is a whole face of its voxel
  SceneBuilder b;
  const uint32_t m = b.material(glm::vec3(0.5f)), bright = b.material(glm::vec3(0.0f), glm::vec3(1000.0f));
  b.box({m, m, m, m, m, m}, glm::vec3(-1), glm::vec3(1), /*inward=*/true);
  b.quad(bright, lamp[0], lamp[1], lamp[2], lamp[3]);  // faces down
  const World w = world(b.finish("tiny-emitter"), settings);
  const FormFactors f = buildMatrix(context(), w.facets, w.field, settings);
  const Emitters emitters = listEmitters(context(), w.facets);
  ASSERT_EQ(emitters.count, 4u);
  const std::vector<uint32_t> voxel = downloadAs<uint32_t>(context(), w.facets.voxel),
                              shape = downloadAs<uint32_t>(context(), w.facets.shape);
  /// RMS and mean of F M on the floor over the closed form, less 1.
  const auto error = [&](EmitterSampling sampling) {
    settings.matrix.emitterSampling = sampling;
    Lighting light = makeLighting(context(), w.facets, settings);
    EXPECT_TRUE(solve(context(), w.facets, f, light, settings, 1000, {&emitters, &w.field}).converged);
    EXPECT_EQ(light.report.nonFinite + light.report.negative, 0u);
    EXPECT_EQ(bool(light.correction), sampling != EmitterSampling::off);
    const std::vector<glm::vec4> got = values(light.emitted);
    double squares = 0, sum = 0, n = 0;
    for (uint32_t i = 0; i < w.facets.count; ++i) {
      if (decodeNormal(shape[i] & 0xFFFFu, NORMALS_OCT16).y < 0.99f) continue;
      const glm::dvec3 p = glm::dvec3(grid.origin) + double{grid.edge} * (glm::dvec3(unpackVoxel(voxel[i])) + 0.5);
      const double ratio = got[i].x / 1000.0 / polygonFactor({p.x, -1, p.z}, {0, 1, 0}, faces);
      squares += (ratio - 1) * (ratio - 1);
      sum += ratio;
      ++n;
    }
    EXPECT_GT(n, 3000);
    return std::pair(std::sqrt(squares / n), sum / n - 1);
  };
  const auto [sampled, bias] = error(EmitterSampling::automatic);
  const auto [traced, unused] = error(EmitterSampling::off);
  fmt::print("tiny emitter: relative RMSE {:.4f} (mean {:+.4f}) with samples, {:.2f} without\n", sampled, bias, traced);
  EXPECT_LE(sampled, 0.05);
  EXPECT_NEAR(bias, 0, 0.002);
  EXPECT_GT(traced, 0.5) << "without samples it is the hard case";
}

TEST_F(EmitterSamples, SamplesOfEmittersKeepTheMeanOfTheirRays) {
  // A lamp of 8 x 8 voxels near a wall: both ways give the same light, in either format.
  Settings settings = at(32, 512);
  settings.matrix.emitterSamples = 128;
  SceneBuilder b;
  const uint32_t m = b.material(glm::vec3(0.7f, 0.5f, 0.2f)), lamp = b.material(glm::vec3(0.1f), glm::vec3(3, 2, 1));
  b.box({m, m, m, m, m, m}, glm::vec3(-1), glm::vec3(1), /*inward=*/true);
  b.quad(lamp, {0.3f, 0.3f, 0.2f}, {0.8f, 0.3f, 0.2f}, {0.8f, 0.3f, 0.7f}, {0.3f, 0.3f, 0.7f});
  const World w = world(b.finish("lamp"), settings);
  const Emitters emitters = listEmitters(context(), w.facets);
  std::vector<double> mean;
  for (const MatrixFormat format : {MatrixFormat::csr, MatrixFormat::padded}) {
    settings.matrix.format = format;
    const FormFactors f = buildMatrix(context(), w.facets, w.field, settings);
    for (const EmitterSource& source : {EmitterSource{}, EmitterSource{&emitters, &w.field}}) {
      Lighting light = makeLighting(context(), w.facets, settings);
      EXPECT_TRUE(solve(context(), w.facets, f, light, settings, 1000, source).converged);
      EXPECT_EQ(bool(light.correction), source.emitters != nullptr);
      double sum = 0;
      for (const glm::vec4& h : values(light.indirect)) sum += h.x;
      mean.push_back(sum / w.facets.count);
    }
  }
  fmt::print("H by rays {:.5f}, by samples {:.5f}\n", mean[0], mean[1]);
  EXPECT_NEAR(mean[1] / mean[0], 1.0, 0.01);
  EXPECT_NEAR(mean[3] / mean[1], 1.0, 1e-4) << "padded rows hold the same hits";
}

TEST_F(EmitterSamples, SamplesThatLoseLightAreNotUsed) {
  // The end of a corridor five voxels wide shines: the walls around take the voxels at its rim.
  Settings settings = at(16, 256);
  settings.voxel.facets = 1;
  SceneBuilder b;
  const uint32_t m = b.material(glm::vec3(0.5f)), lamp = b.material(glm::vec3(0.1f), glm::vec3(30));
  b.box({m, m, m, m, m, lamp}, glm::vec3(-0.3f, -0.3f, -1), glm::vec3(0.3f, 0.3f, 1), /*inward=*/true);
  const World w = world(b.finish("corridor"), settings);
  const Emitters emitters = listEmitters(context(), w.facets);
  const FormFactors f = buildMatrix(context(), w.facets, w.field, settings);
  const auto solved = [&](EmitterSampling sampling) {
    settings.matrix.emitterSampling = sampling;
    Lighting light = makeLighting(context(), w.facets, settings);
    EXPECT_TRUE(solve(context(), w.facets, f, light, settings, 1000, {&emitters, &w.field}).converged);
    return light;
  };
  const Lighting automatic = solved(EmitterSampling::automatic), rays = solved(EmitterSampling::off);
  fmt::print("corridor: samples see {:.3f} of the rays' light\n", automatic.sampledShare);
  ASSERT_LT(automatic.sampledShare, 0.9f);
  EXPECT_FALSE(automatic.correction);
  EXPECT_EQ(values(automatic.emitted), values(rays.emitted));
  EXPECT_EQ(values(automatic.indirect), values(rays.indirect));
}

}  // namespace
}  // namespace irad::test
