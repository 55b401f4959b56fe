// The first gather by samples of the emitters against that by rays (METHOD section 5); against a closed form: `irad
// check tiny-emitter`.
#include "tests/gi_fixture.h"

namespace irad::test {
namespace {

class EmitterSamples : public GiTest {
 protected:
  std::vector<glm::vec4> values(const Buffer& buffer) { return downloadAs<glm::vec4>(context(), buffer); }
};

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
