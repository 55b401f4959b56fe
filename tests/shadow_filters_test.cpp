// Filters of shadow maps and lights with a size: variance shadow maps against single comparisons, penumbrae against
// geometry and the path tracer, in pixels and in facets alike.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "gi/check/path_tracer.h"
#include "gi/host_facets.h"
#include "tests/lit_stage.h"

namespace irad::test::shadow_filters_suite {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr uint32_t kPixels = 128;

class ShadowFilters : public GpuTest {};

void addPlate(SceneBuilder& b, glm::vec3 corner, glm::vec3 u, glm::vec3 v) {
  b.newMaterial().doubleSided = true;
  b.addQuad(corner, u, v);
}

/// A floor, and a box above it.
SceneBuilder boxOverFloor() {
  SceneBuilder b;
  b.addQuad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
  b.addBox({-0.6f, 0.4f, -0.5f}, {0.5f, 1.1f, 0.4f});
  b.addCamera({0, 6, 0}, {0, 0, 0}, 0.9f, {0, 0, -1});
  return b;
}
Light& lampAbove(SceneBuilder& b, LightType type) {
  Light& light = b.addLight(type, 50);
  light.position = {1.6, 3, -1.1};
  light.direction = glm::normalize(glm::vec3(-1.6f, -3, 1.1f));
  light.outerCos = std::cos(1.1f);
  light.innerCos = std::cos(1.0f);
  return light;
}

Settings filtered(ShadowFilter filter, uint32_t resolution = 512) {
  Settings settings;
  settings.light.shadowResolution = resolution;
  settings.light.shadowFilter = filter;
  return settings;
}

std::vector<float> shadowOf(Context& context, const Scene& scene, const Settings& settings) {
  Stage stage(context, scene, settings);
  ViewInputs inputs;
  inputs.scene = &stage.device;
  inputs.shadows = &stage.shadows;
  std::vector<float> seen;
  for (const glm::vec4& c : stage.draw(VIEW_SHADOW, {kPixels, kPixels}, 0, inputs).linear) seen.push_back(c.x);
  return seen;
}

/// The least and the largest value within `reach` pixels.
std::pair<float, float> around(const std::vector<float>& picture, uint32_t x, uint32_t y, uint32_t reach) {
  float lo = 1, hi = 0;
  for (uint32_t j = y - std::min(y, reach); j <= std::min(y + reach, kPixels - 1); ++j)
    for (uint32_t i = x - std::min(x, reach); i <= std::min(x + reach, kPixels - 1); ++i) {
      lo = std::min(lo, picture[j * kPixels + i]);
      hi = std::max(hi, picture[j * kPixels + i]);
    }
  return {lo, hi};
}

/// A pixel is 4.5 cm of the floor, a texel of the coarsest map, the cube's, 2.5 cm: the filter's footprint, two texels
/// to each side and as much again by the slant, lies within three pixels.
TEST_F(ShadowFilters, EqualOneComparisonAwayFromEdges) {
  for (const LightType type : {LightType::Sun, LightType::Spot, LightType::Point})
    for (const ShadowFilter filter : {ShadowFilter::vsm, ShadowFilter::pcf}) {
      SceneBuilder b = boxOverFloor();
      lampAbove(b, type);
      const Scene scene = b.finish();
      const uint32_t texels = type == LightType::Sun ? 96 : 512;  // its map is of the box alone
      const std::vector<float> hard = shadowOf(context(), scene, filtered(ShadowFilter::hard, texels)),
                               soft = shadowOf(context(), scene, filtered(filter, texels));
      uint32_t compared = 0, dark = 0, edge = 0;
      for (uint32_t y = 0; y < kPixels; ++y)
        for (uint32_t x = 0; x < kPixels; ++x) {
          const float value = soft[y * kPixels + x];
          EXPECT_TRUE(hard[y * kPixels + x] == 0 || hard[y * kPixels + x] == 1);
          const auto [lo, hi] = around(hard, x, y, 3);
          if (lo != hi) {
            edge += value > 0.02f && value < 0.98f;
            continue;
          }
          ++compared;
          dark += lo == 0;
          ASSERT_NEAR(value, lo, 0.01) << lightKind(type).name << " " << nameOf(filter) << " at " << x << " " << y;
        }
      EXPECT_GT(compared, kPixels * kPixels / 2) << lightKind(type).name;
      EXPECT_GT(dark, 50u) << lightKind(type).name;
      EXPECT_GT(edge, 20u) << "nothing is filtered";
    }
}

/// No surface shades itself, whatever the filter and the slant.
TEST_F(ShadowFilters, NoAcne) {
  for (const ShadowFilter filter : {ShadowFilter::hard, ShadowFilter::vsm})
    for (const LightType type : {LightType::Sun, LightType::Spot, LightType::Point})
      for (const float size : {0.0f, 0.1f}) {
        SceneBuilder b;
        b.addQuad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
        b.addQuad({-6, -2, 6}, {12, 0, 0}, {0, 0, -12});
        b.addCamera({0, 5, 0}, {0, 0, 0}, 0.8f, {0, 0, -1});
        Light& light = lampAbove(b, type);
        light.radius = type == LightType::Sun ? 0 : size;
        light.angle = type == LightType::Sun ? 10 * size : 0;
        for (const float seen : shadowOf(context(), b.finish(), filtered(filter)))
          ASSERT_EQ(seen, 1) << nameOf(filter) << " " << lightKind(type).name << " " << size;
      }
}

/// Under the sun's plates at 2 and .5 above the floor, of which the lower alone covers some of it, Chebyshev's bound is
/// largest where a fifth of a texel's surroundings are the upper one: variance 2.25 x .2 x .8 against (.5 + 1.5 x
/// .2)^2.
TEST_F(ShadowFilters, BleedReductionDarkensWhatLiesUnderTwo) {
  SceneBuilder b;
  b.addQuad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
  addPlate(b, {-3, 2, 3}, {3, 0, 0}, {0, 0, -6});
  addPlate(b, {-3, 0.5f, 3}, {6, 0, 0}, {0, 0, -6});
  b.addLight(LightType::Sun, 1).direction = {0, -1, 0};
  b.addCamera({0, 0.45, 0}, {0, 0, 0}, 0.2f, {0, 0, -1});
  const Scene scene = b.finish();
  const auto brightest = [&](float reduction) {
    Settings settings = filtered(ShadowFilter::vsm);
    settings.camera.gpu.pcf = 5;
    settings.light.bleedReduction = reduction;
    return std::ranges::max(shadowOf(context(), scene, settings));
  };
  const float most = 0.36f;
  EXPECT_NEAR(brightest(0), most, 0.01);
  EXPECT_NEAR(brightest(0.3f), (most - 0.3f) / 0.7f, 0.015);
  EXPECT_EQ(brightest(0.4f), 0);
  EXPECT_EQ(std::ranges::max(shadowOf(context(), scene, filtered(ShadowFilter::hard))), 0);
}

TEST_F(ShadowFilters, MomentsTakeMemoryWithTheirFilterAlone) {
  SceneBuilder b = boxOverFloor();
  lampAbove(b, LightType::Sun);
  lampAbove(b, LightType::Point);
  const Scene scene = b.finish();
  for (const ShadowFilter filter : {ShadowFilter::hard, ShadowFilter::pcf, ShadowFilter::vsm}) {
    const Stage stage(context(), scene, filtered(filter));
    context().finish();
    uint64_t texels = 0;
    for (const MemoryRow& row : context().device.memory().rows())
      if (row.name.starts_with("shadow")) texels += row.texelBytes;
    EXPECT_EQ(texels, shadowTexelBytes(filter) * (512 * 512 + 6 * 256 * 256)) << nameOf(filter);
  }
}

/// The share of a disc of radius 1 on the far side of a line at `t` from its middle.
double discShare(double t) {
  t = std::clamp(t, -1.0, 1.0);
  return 0.5 + (std::asin(t) + t * std::sqrt(1 - t * t)) / kPi;
}
/// The width between shares of .05 and .95, of a penumbra that is 2 across.
double disc90() {
  double lo = 0, hi = 1;
  for (int i = 0; i < 60; ++i) (discShare(0.5 * (lo + hi)) < 0.95 ? lo : hi) = 0.5 * (lo + hi);
  return 2 * lo;
}

/// The light of which a plate, .8 above the floor, leaves x > 0; the camera is under the plate and sees the floor from
/// -.4 to .4 both ways.
struct Edge {
  Scene scene;
  double half;        ///< of the penumbra's width on the floor, m
  double irradiance;  ///< at x = 0, W/m^2
  static constexpr float kHeight = 0.8f, kLamp = 2, kSeen = 0.4f;
  Edge(LightType type, double size) {
    SceneBuilder b;
    b.addQuad({-1.5f, 0, 1.5f}, {3, 0, 0}, {0, 0, -3});
    addPlate(b, {-1.5f, kHeight, 1.5f}, {1.5f, 0, 0}, {0, 0, -3});
    Light& light = b.addLight(type, type == LightType::Sun ? 1 : kLamp * kLamp);
    light.position = {0, kLamp, 0};
    light.direction = {0, -1, 0};
    light.outerCos = std::cos(0.9f);
    light.innerCos = std::cos(0.8f);
    if (type == LightType::Sun) {
      light.angle = static_cast<float>(size);
      half = std::tan(size * kPi / 360) * double{kHeight};
    } else {
      light.radius = static_cast<float>(size);
      half = size * double{kHeight} / double{kLamp - kHeight};
    }
    b.addCamera({0, 0.7, 0}, {0, 0, 0}, 2 * std::atan(kSeen / 0.7f), {0, 0, -1});
    scene = b.finish();
  }
  double expected(double x) const { return discShare(x / half); }
};

struct Profile {
  std::vector<double> sum = std::vector<double>(kBins), count = std::vector<double>(kBins);
  static constexpr int kBins = static_cast<int>(kPixels);
  static double middle(int bin) { return (2.0 * bin + 1 - kBins) / kBins * double{Edge::kSeen}; }
  void add(double x, double share) {
    const double at = std::floor((x / double{Edge::kSeen} + 1) / 2 * kBins);
    if (at < 0 || at >= kBins) return;
    sum[static_cast<size_t>(at)] += share;
    ++count[static_cast<size_t>(at)];
  }
  double at(int bin) const { return sum[static_cast<size_t>(bin)] / count[static_cast<size_t>(bin)]; }
  double meanDifference(const Edge& edge) const {
    double off = 0;
    for (int i = 0; i < kBins; ++i) off += std::abs(at(i) - edge.expected(middle(i))) / kBins;
    return off;
  }
  /// Between the shares .05 and .95.
  double width() const {
    const auto where = [&](double share) {
      for (int i = 1; i < kBins; ++i)
        if (at(i - 1) <= share && at(i) > share)
          return middle(i - 1) + (middle(i) - middle(i - 1)) * (share - at(i - 1)) / (at(i) - at(i - 1));
      return 1e9;
    };
    return where(0.95) - where(0.05);
  }
};

Profile pixels(Context& context, const Edge& edge, Settings settings) {
  settings.light.shadowResolution = 1024;
  const std::vector<float> seen = shadowOf(context, edge.scene, settings);
  Profile p;
  for (uint32_t i = 0; i < kPixels * kPixels; ++i)
    p.add((2.0 * (i % kPixels) + 1 - kPixels) / kPixels * double{Edge::kSeen}, seen[i]);
  return p;
}

/// By surfels' middles: facets that straddle the edge have light of both sides.
Profile facets(Context& context, const Edge& edge, Settings settings) {
  settings.voxel.resolution = 64;
  settings.matrix.gpu.rays = 1;
  Lit lit(context, edge.scene, settings);
  const HostFacets host = hostFacets(context, lit.facets);
  const std::vector<glm::vec3> direct = perFacet(context, lit.facets, lit.light.direct);
  const glm::dvec3 origin = edge.scene.origin;
  Profile p;
  for (size_t i = 0; i < host.count(); ++i) {
    const glm::dvec3 at = host.position[i] + origin;
    if (host.normal[i].y < 0.9 || at.y > 0.1 || std::abs(at.z) > double{Edge::kSeen}) continue;
    const Light& light = edge.scene.lights[0];
    const glm::dvec3 way = light.position - at;
    const double whole = light.type == LightType::Sun ? double{light.intensity}
                                                      : double{light.intensity} * way.y / std::pow(glm::length(way), 3);
    p.add(at.x, double{direct[i].x} / whole);
  }
  return p;
}

const std::vector<std::pair<LightType, double>> kSized{{LightType::Sun, 5},
                                                       {LightType::Sun, 20},
                                                       {LightType::Point, 0.1},
                                                       {LightType::Point, 0.3},
                                                       {LightType::Spot, 0.2}};

/// With few points the search may miss what covers little of the light: at 32 of them penumbrae come out up to a
/// fifteenth too narrow.
TEST_F(ShadowFilters, PenumbraeHaveTheWidthThatGeometryGives) {
  for (const auto& [type, size] : kSized) {
    const Edge edge(type, size);
    Settings settings = filtered(ShadowFilter::pcf);
    settings.light.points = 256;
    const Profile p = pixels(context(), edge, settings);
    fmt::print("{} of {}: width {:.4f} of {:.4f}, mean difference {:.4f}\n", lightKind(type).name, size, p.width(),
               edge.half * disc90(), p.meanDifference(edge));
    EXPECT_NEAR(p.width() / (edge.half * disc90()), 1, 0.03) << lightKind(type).name << " " << size;
    EXPECT_LT(p.meanDifference(edge), 0.002) << lightKind(type).name << " " << size;
  }
}

TEST_F(ShadowFilters, FacetsSeeTheSamePenumbra) {
  for (const auto& [type, size] : kSized)
    for (const HitRule rule : {HitRule::triangles, HitRule::thesis}) {
      Settings settings = filtered(ShadowFilter::pcf);
      settings.matrix.gpu.hitRule = rule;
      const Edge edge(type, size);
      const Profile f = facets(context(), edge, settings), p = pixels(context(), edge, settings);
      // Bins are narrower than voxels, so that some are empty.
      double off = 0, bins = 0;
      for (int i = 0; i < Profile::kBins; ++i)
        if (f.count[static_cast<size_t>(i)] > 0) off += std::abs(f.at(i) - p.at(i)), ++bins;
      fmt::print("{} of {}, {}: facets and pixels differ by {:.4f} in the mean\n", lightKind(type).name, size,
                 nameOf(rule), off / bins);
      ASSERT_GT(bins, 15);
      EXPECT_LT(off / bins, 0.02) << lightKind(type).name << " " << size << " " << nameOf(rule);
    }
}

TEST_F(ShadowFilters, ThePathTracerSeesTheSamePenumbra) {
  if (!hasPathTracer()) GTEST_SKIP() << "no Embree";
  for (const auto& [type, size] : kSized) {
    Edge edge(type, size);
    for (Material& m : edge.scene.materials) m.baseColor = glm::vec4(0.5f, 0.5f, 0.5f, 1);
    const TracedPicture traced =
        makePathTracer(edge.scene)->render(edge.scene.cameras[0], {kPixels, kPixels}, {.samples = 64, .centred = true});
    Profile p;
    for (uint32_t i = 0; i < kPixels * kPixels; ++i) {
      const double k = double{Edge::kSeen} / kPixels, x = (2.0 * (i % kPixels) + 1 - kPixels) * k,
                   z = (2.0 * std::floor(i / kPixels) + 1 - kPixels) * k;
      const double d = std::sqrt(x * x + z * z + 4);
      const double whole = type == LightType::Sun ? 1 : 4 * 2 / (d * d * d);
      p.add(x, (traced.lit.mean[i].x - traced.indirect.mean[i].x) * kPi / 0.5 / whole);
    }
    EXPECT_LT(p.meanDifference(edge), 0.005) << lightKind(type).name << " " << size;
  }
}

TEST_F(ShadowFilters, SeveralLightsOfEachKindAddUp) {
  for (const ShadowFilter filter : {ShadowFilter::hard, ShadowFilter::pcf, ShadowFilter::vsm}) {
    const auto draw = [&](const std::vector<Light>& lights) {
      SceneBuilder b = boxOverFloor();
      b.scene.lights = lights;
      Stage stage(context(), b.finish(), filtered(filter));
      return stage.draw(VIEW_DIRECT, {64, 64}).linear;
    };
    SceneBuilder b;
    for (const LightType type : {LightType::Sun, LightType::Spot, LightType::Point})
      for (const float size : {0.0f, 0.2f}) {
        Light& light = lampAbove(b, type);
        light.intensity = 3;
        light.position.x -= 2 * double{size};
        light.radius = type == LightType::Sun ? 0 : size;
        light.angle = type == LightType::Sun ? 20 * size : 0;
      }
    const std::vector<glm::vec4> together = draw(b.scene.lights);
    std::vector<double> sum(together.size());
    for (const Light& light : b.scene.lights) {
      const std::vector<glm::vec4> alone = draw({light});
      for (size_t i = 0; i < sum.size(); ++i) sum[i] += double{alone[i].x};
    }
    // Targets are half floats: 2^-11 of each of the pictures.
    for (size_t i = 0; i < sum.size(); ++i)
      ASSERT_NEAR(double{together[i].x}, sum[i], 2e-3 * std::max(sum[i], 0.1)) << nameOf(filter) << " " << i;
  }
}

TEST_F(ShadowFilters, LightsWithoutASizeHaveOneShadowWhateverThePoints) {
  SceneBuilder b = boxOverFloor();
  for (const LightType type : {LightType::Sun, LightType::Spot, LightType::Point}) lampAbove(b, type);
  const Scene scene = b.finish();
  const auto draw = [&](uint32_t points) {
    Settings settings = filtered(ShadowFilter::pcf);
    settings.light.points = points;
    settings.voxel.resolution = 24;
    settings.matrix.gpu.rays = 16;
    Lit lit(context(), scene, settings);
    std::vector<glm::vec4> all = lit.stage.draw(VIEW_LIT, {64, 64}, 0, lit.inputs(), lit.indirect()).linear;
    for (const glm::vec3& d : perFacet(context(), lit.facets, lit.light.direct)) all.emplace_back(d, 0);
    return all;
  };
  EXPECT_EQ(draw(1), draw(64));
}

}  // namespace
}  // namespace irad::test::shadow_filters_suite
