// Light from a sky (gi/sky.h): closed forms, the bins that rays escape into, pictures against the path tracer, and that
// a sky which is not there costs no bit.
#include "gi/sky.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <numbers>

#include "gi/check/path_tracer.h"
#include "gi/host_trace.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/oracle/rays.h"
#include "gi/pipeline.h"
#include "gi/plan.h"
#include "gi/preetham.h"
#include "gi/ray_kernel.h"
#include "renderer/base/error.h"
#include "renderer/base/image_io.h"
#include "renderer/targets.h"
#include "tests/gi_fixture.h"

namespace irad::test::sky_suite {
namespace {

constexpr double kPi = std::numbers::pi;

/// A sky that differs in every direction: bluer above, brighter in the west, dark below.
std::shared_ptr<const SkyImage> evening(glm::uvec2 size = {128, 64}) {
  auto texels = std::make_shared<SkyTexels>();
  texels->size = size;
  texels->texels.clear();
  for (uint32_t y = 0; y < size.y; ++y)
    for (uint32_t x = 0; x < size.x; ++x) {
      const float height =
                      std::cos(static_cast<float>(kPi) * (static_cast<float>(y) + 0.5f) / static_cast<float>(size.y)),
                  west = 0.5f + 0.5f * std::cos(2 * static_cast<float>(kPi) * (static_cast<float>(x) + 0.5f) /
                                                static_cast<float>(size.x));
      texels->texels.push_back(height < 0 ? glm::vec3(0.1f, 0.08f, 0.05f)
                                          : glm::mix(glm::vec3(0.6f + 3 * west * west, 0.6f + west, 0.5f),
                                                     glm::vec3(0.2f, 0.4f, 1.0f), std::sqrt(height)));
    }
  return std::make_shared<SkyImage>(withoutSun(texels));
}

Sky skyOf(std::shared_ptr<const SkyTexels> texels, float turn = 0) {
  return {.texels = texels, .whole = texels, .turn = turn, .scale = glm::vec3(1)};
}

class Skies : public GiTest {
 protected:
  static Settings under(SkySource source, uint32_t resolution = 16, uint32_t rays = 128) {
    Settings s = at(resolution, rays);
    s.sky.source = source;
    return s;
  }
  std::vector<glm::vec4> values(const Buffer& buffer, uint32_t count) {
    std::vector<glm::vec4> v = downloadAs<glm::vec4>(context(), buffer);
    v.resize(count);
    return v;
  }
  std::vector<glm::vec4> irradiance(const Pipeline& p) { return values(p.lighting().indirect, p.facets().count); }
  std::vector<glm::vec4> radiosity(const Pipeline& p) { return values(p.lighting().radiosity, p.facets().count); }
  /// Mean by the facets' areas, of the first channel.
  double mean(const Pipeline& p, const std::vector<glm::vec4>& of) {
    const std::vector<float> area = downloadAs<float>(context(), p.facets().area);
    double sum = 0, all = 0;
    for (size_t i = 0; i < of.size(); ++i) sum += double{area[i]} * of[i].x, all += area[i];
    return sum / all;
  }
  std::vector<glm::vec4> picture(Pipeline& pipeline, glm::uvec2 size, View view = VIEW_LIT) {
    Targets targets(context(), size);
    Frame frame = context().begin();
    pipeline.render(frame, pipeline.scene().cameras.at(0), view, targets);
    frame.submitAndWait();
    const std::vector<std::byte> bytes = download(context(), targets.linear);
    std::vector<glm::vec4> pixels(bytes.size() / sizeof(glm::vec4));
    std::memcpy(pixels.data(), bytes.data(), bytes.size());
    return pixels;
  }
};

TEST_F(Skies, AConvexBodyReflectsTheWhiteSky) {
  // No ray meets anything: H = pi L, B = rho H.
  SceneBuilder b;
  const uint32_t grey = b.material(glm::vec3(0.5f));
  b.edit(grey).lambertian = true;
  b.sphere(grey, glm::vec3(0), 1, /*inward=*/false, 32);
  b.camera({0, 0, 4}, {0, 0, 0});
  Pipeline p(context(), b.finish("ball"), under(SkySource::constant));
  p.prepare();
  EXPECT_EQ(p.matrix().stats.hits, 0u);
  for (const glm::vec4& h : irradiance(p)) EXPECT_NEAR(h.x, kPi, 1e-5);
  for (const glm::vec4& v : radiosity(p)) EXPECT_NEAR(v.y, 0.5 * kPi, 1e-4);  // albedos have 16 bits
  ASSERT_TRUE(p.lighting().report.energy);
  EXPECT_NEAR(p.lighting().report.energy->imbalance(), 0, 1e-6);
  // A ball in front of the sky that it reflects: .5 against 1.
  const std::vector<glm::vec4> seen = picture(p, {64, 64});
  EXPECT_EQ(glm::vec3(seen[0]), glm::vec3(1));
  EXPECT_NEAR(seen[32 * 64 + 32].x, 0.5, 1e-3);
}

TEST_F(Skies, AnOpenSphereIsAnIntegratingOne) {
  // From every point of a sphere each part of it is seen by its share of the area: B = rho (pi L f + B (1 - f)).
  for (const float rho : {0.5f, 0.9f}) {
    SceneBuilder b;
    constexpr uint32_t kRings = 64, kOpen = 16;
    b.zone(b.material(glm::vec3(rho)), glm::vec3(0), 1, /*inward=*/true, kRings, kOpen, kRings);
    Pipeline p(context(), b.finish("open sphere"), under(SkySource::constant, 24, 512));
    p.prepare();
    const double f = 0.5 * (1 - std::cos(kPi * kOpen / kRings)), expected = rho * kPi * f / (1 - rho * (1 - f));
    const double found = mean(p, radiosity(p));
    fmt::print("open sphere, rho {}: B {:.5f}, expected {:.5f}, ratio {:.5f}; imbalance {:.5f}\n", rho, found, expected,
               found / expected, p.lighting().report.energy->imbalance());
    EXPECT_NEAR(found / expected, 1, 0.005);
    EXPECT_NEAR(p.lighting().report.energy->imbalance(), 0, 0.005);
  }
}

TEST_F(Skies, AnOpenBoxSeesTheSkyByFormFactors) {
  // The floor of a black box, open above; each wall likewise.
  SceneBuilder b;
  std::vector<uint32_t> wall;
  for (int i = 0; i < 5; ++i) wall.push_back(b.material(glm::vec3(0)));
  const float h = 0.5f;
  b.quad(wall[0], {-h, -h, h}, {h, -h, h}, {h, -h, -h}, {-h, -h, -h});
  b.quad(wall[1], {-h, -h, -h}, {h, -h, -h}, {h, h, -h}, {-h, h, -h});
  b.quad(wall[2], {h, -h, h}, {-h, -h, h}, {-h, h, h}, {h, h, h});
  b.quad(wall[3], {-h, -h, h}, {-h, -h, -h}, {-h, h, -h}, {-h, h, h});
  b.quad(wall[4], {h, -h, -h}, {h, -h, h}, {h, h, h}, {h, h, -h});
  Settings s = under(SkySource::constant, 16, 512);
  s.effects.matrix = EffectMode::on;  // black walls show no H
  Pipeline p(context(), b.finish("open box"), s);
  p.prepare();
  const HostFacets facets = hostFacets(context(), p.facets());
  const std::vector<glm::vec4> found = irradiance(p);
  double floor = 0, floorArea = 0, walls = 0, wallArea = 0;
  for (size_t i = 0; i < facets.count(); ++i) {
    const bool up = facets.normal[i].y > 0.5;
    (up ? floor : walls) += facets.area[i] * found[i].x;
    (up ? floorArea : wallArea) += facets.area[i];
  }
  floor /= floorArea * kPi, walls /= wallArea * kPi;
  fmt::print("open box: floor {:.5f} of {:.5f}, walls {:.5f} of {:.5f}\n", floor, formFactorParallelSquares(1), walls,
             formFactorPerpendicularSquares());
  EXPECT_NEAR(floor / formFactorParallelSquares(1), 1, 0.01);
  EXPECT_NEAR(walls / formFactorPerpendicularSquares(), 1, 0.01);
}

TEST_F(Skies, BinsHoldTheirDirections) {
  std::vector<uint32_t> seen(SKY_BINS);
  for (uint32_t bin = 0; bin < SKY_BINS; ++bin)
    for (const glm::vec2 within : {glm::vec2(0.5f), glm::vec2(0.01f, 0.99f), glm::vec2(0.99f, 0.01f)}) {
      const glm::vec3 p = skyBinPoint(bin, within, SKY_EDGE);
      EXPECT_EQ(skyBin(p, SKY_EDGE), bin);
      EXPECT_EQ(skyBin(glm::normalize(p), SKY_EDGE), bin);
    }
  // A floor's horizon is a border, and so are those of walls along the axes.
  for (int axis = 0; axis < 3; ++axis)
    for (uint32_t bin = 0; bin < SKY_BINS; ++bin)
      EXPECT_GT(
          skyBinPoint(bin, glm::vec2(1e-4f), SKY_EDGE)[axis] * skyBinPoint(bin, glm::vec2(0.9999f), SKY_EDGE)[axis], 0);
  // Kept within their bits, and apart from facets and from what else a ray meets.
  EXPECT_LE(SKY_BINS, 1u << SKY_BIN_BITS);
  EXPECT_FALSE(isSky(TRACE_LAST_FACET) || isSky(TRACE_ESCAPED) || isSky(TRACE_NOT_CAST));
}

TEST_F(Skies, KernelAndHostEscapeIntoTheSameBins) {
  if (!canTraceOnHost()) GTEST_SKIP() << "this build cannot trace on the host (IRAD_EMBREE)";
  const World w = world(stillLife().finish("still life"), at(24, 64));
  const MatrixParams& params = w.settings.matrix.gpu;
  const size_t rays = size_t{w.facets.count} * params.rays;
  const Buffer hits(context().device, "hits", Subsystem::Staging, 4 * rays);
  Frame frame = context().begin();
  traceRows(frame, rayKernel(w.facets, w.field, params), params, 0, w.facets.count, hits, /*sky=*/true);
  frame.submitAndWait();
  const std::vector<uint32_t> kernel = downloadAs<uint32_t>(context(), hits);
  std::vector<uint32_t> host(rays);
  makeHostTrace(context(), w.facets)->rows(params, 0, w.facets.count, host, /*threads=*/0, /*sky=*/true);
  const oracle::Facets facets = oracleFacets(context(), w.facets);
  size_t escaped = 0, differ = 0, wrong = 0;
  for (uint32_t f = 0; f < w.facets.count; ++f)
    for (uint32_t k = 0; k < oracle::raysOf(facets, f, params); ++k) {
      const uint32_t met = host[size_t{f} * params.rays + k];
      differ += met != kernel[size_t{f} * params.rays + k];
      if (!isSky(met)) continue;
      ++escaped;
      wrong += met != metSky(glm::vec3(oracle::facetRay(facets, f, k, params).direction));
      EXPECT_NE(met, TRACE_ESCAPED);
    }
  fmt::print("{} of {} rays escape; {} differ between kernel and host, {} from the oracle's direction\n", escaped, rays,
             differ, wrong);
  EXPECT_GT(escaped, rays / 10);
  EXPECT_LE(differ, rays / 50'000 + 3);
  EXPECT_LE(wrong, rays / 50'000 + 3);
}

TEST_F(Skies, WhatThereIsNotChangesNoBit) {
  const auto room = [] { return stillLife().finish("still life"); };
  const Settings usual = at(16, 64);
  Settings forced = usual, lit = usual;
  forced.effects.sky = EffectMode::on;
  lit.sky.source = SkySource::constant;
  Pipeline without(context(), room(), usual), kept(context(), room(), forced), with(context(), room(), lit);
  for (Pipeline* p : {&without, &kept, &with}) p->prepare();
  EXPECT_FALSE(without.matrix().rowSky || without.lighting().sky || kept.lighting().sky);
  EXPECT_TRUE(kept.matrix().rowSky && with.matrix().rowSky && with.lighting().sky);
  EXPECT_EQ(irradiance(kept), irradiance(without));
  EXPECT_EQ(radiosity(kept), radiosity(without));
  EXPECT_EQ(picture(kept, {64, 64}), picture(without, {64, 64}));
  // Whoever reads rows of facets does not come upon the sky's entries.
  const std::vector<HostRow> rows = hostRows(context(), without.matrix()), beside = hostRows(context(), with.matrix());
  ASSERT_EQ(rows.size(), beside.size());
  for (size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].columns, beside[i].columns);
    EXPECT_EQ(rows[i].hits, beside[i].hits);
    EXPECT_EQ(rows[i].weight, beside[i].weight);
  }
  EXPECT_EQ(without.matrix().stats.escaped, with.matrix().stats.escaped);
  EXPECT_EQ(without.matrix().stats.largestRow, with.matrix().stats.largestRow);
}

TEST_F(Skies, TheThesisHasNone) {
  Settings s = under(SkySource::constant);
  s.matrix.gpu.hitRule = HitRule::thesis;
  Pipeline p(context(), stillLife().finish("still life"), s);
  p.prepare();
  EXPECT_TRUE(contains(p.plan().row(Effect::sky).reason, "matrix.hit_rule = thesis, which has no sky"));
  EXPECT_TRUE(p.plan().off(Effect::sky));
  EXPECT_FALSE(p.matrix().rowSky || p.lighting().sky);
}

TEST_F(Skies, AnotherIntensityOrRotationRelightsAlone) {
  Settings s = under(SkySource::image);
  Pipeline p(context(), stillLife(/*light=*/0).finish("still life"), s);
  p.setSky(evening());
  p.prepare();
  const uint64_t build = p.revision().build;
  const std::vector<glm::vec4> once = irradiance(p);
  const auto change = [&](const std::function<void(SkySettings&)>& edit) {
    edit(s.sky);
    EXPECT_EQ(p.set(s), Redo::Gather);
    p.prepare();
    EXPECT_EQ(p.revision().build, build);
  };
  change([](SkySettings& sky) { sky.intensity = 3; });
  const std::vector<glm::vec4> thrice = irradiance(p);
  for (size_t i = 0; i < once.size(); ++i) EXPECT_NEAR(thrice[i].x, 3 * once[i].x, 0.02 * thrice[i].x + 1e-3);
  change([](SkySettings& sky) { sky.rotation = 90; });
  EXPECT_NE(irradiance(p), thrice);
  change([](SkySettings& sky) { sky.rotation = 360, sky.intensity = 1; });
  double difference = 0, sum = 0;
  const std::vector<glm::vec4> around = irradiance(p);
  for (size_t i = 0; i < once.size(); ++i) difference += std::abs(around[i].x - once[i].x), sum += once[i].x;
  EXPECT_LT(difference, 2e-3 * sum);
  change([](SkySettings& sky) { sky.source = SkySource::constant; });
  // Turned down it sleeps, and keeps what was built for it.
  change([](SkySettings& sky) { sky.intensity = 0; });
  EXPECT_EQ(p.plan().row(Effect::sky).state, EffectState::asleep);
  EXPECT_FALSE(p.lighting().sky);
  change([](SkySettings& sky) { sky.intensity = 2; });
  EXPECT_TRUE(p.plan().on(Effect::sky));
  // Without a sky what was built for one is given back.
  s.sky.source = SkySource::none;
  EXPECT_EQ(p.set(s), Redo::Matrix);
}

TEST_F(Skies, APictureTurnsAboutTheVertical) {
  const Sky still = skyOf(evening()->texels), turned = skyOf(evening()->texels, 0.25f);
  // By the right hand about +Y: what was at -Z goes to -X.
  for (const glm::vec3& d : {glm::vec3(0.3f, 0.5f, -0.8f), glm::vec3(0, 1, 0), glm::vec3(-0.6f, 0.1f, 0.2f)})
    EXPECT_LT(
        glm::distance(turned.radiance(glm::normalize(glm::vec3(d.z, d.y, -d.x))), still.radiance(glm::normalize(d))),
        1e-3f);
  // The picture's middle is -Z, its right half is towards +X, its top is up.
  auto texels = std::make_shared<SkyTexels>();
  texels->size = {4, 2};
  texels->texels = {glm::vec3(1), glm::vec3(1), glm::vec3(2), glm::vec3(2),
                    glm::vec3(3), glm::vec3(3), glm::vec3(4), glm::vec3(4)};
  const Sky quarters = skyOf(texels);
  EXPECT_NEAR(quarters.radiance(glm::normalize(glm::vec3(1, 1, 0))).x, 2, 1e-5);
  EXPECT_NEAR(quarters.radiance(glm::normalize(glm::vec3(-1, 1, 0))).x, 1, 1e-5);
  EXPECT_NEAR(quarters.radiance(glm::normalize(glm::vec3(1, -1, 0))).x, 4, 1e-5);
  EXPECT_NEAR(quarters.radiance(glm::normalize(glm::vec3(0, 1, -1))).x, 1.5, 1e-5);
}

TEST_F(Skies, BinsAreFineEnough) {
  const World w = world(stillLife(0).finish("still life"), at(12, 128));
  const Sky sky = skyOf(evening({512, 256})->texels, 0.1f);
  const oracle::Facets facets = oracleFacets(context(), w.facets);
  constexpr uint32_t kStep = 3;  // every third facet tells as much
  // Each facet's irradiance by so many rays, each by what `radiance` makes of its direction; W/m^2 over pi.
  const auto gathered = [&](uint32_t rays, const std::function<float(const glm::vec3&)>& radiance) {
    MatrixParams params = w.settings.matrix.gpu;
    params.rays = rays;
    const Buffer hits(context().device, "hits", Subsystem::Staging, 4ull * w.facets.count * rays);
    Frame frame = context().begin();
    traceRows(frame, rayKernel(w.facets, w.field, params), params, 0, w.facets.count, hits);
    frame.submitAndWait();
    const std::vector<uint32_t> met = downloadAs<uint32_t>(context(), hits);
    std::vector<double> found(w.facets.count);
    for (uint32_t f = 0; f < w.facets.count; f += kStep)
      for (uint32_t k = 0, n = oracle::raysOf(facets, f, params); k < n; ++k)
        if (met[size_t{f} * rays + k] == TRACE_ESCAPED)
          found[f] += radiance(glm::vec3(oracle::facetRay(facets, f, k, params).direction)) / n;
    return found;
  };
  const auto exactly = [&](const glm::vec3& d) { return sky.radiance(d).x; };
  constexpr uint32_t kMany = 1024;
  const std::vector<double> truth = gathered(kMany, exactly);
  struct Error {
    double rms = 0, sum = 0;  ///< shares of the mean, by the facets' areas
  };
  const auto error = [&](const std::vector<double>& found) {
    double squares = 0, sum = 0, truthSum = 0, all = 0;
    for (uint32_t f = 0; f < w.facets.count; f += kStep) {
      const double area = facets.area[f], off = found[f] - truth[f];
      squares += area * off * off, sum += area * off, truthSum += area * truth[f], all += area;
    }
    return Error{std::sqrt(squares / all) * all / truthSum, sum / truthSum};
  };
  const Error noise = error(gathered(128, exactly));
  fmt::print("noise of 128 rays: {:.2f} % of the mean (rms)\n", 100 * noise.rms);
  for (const uint32_t edge : {4u, 8u, 16u}) {
    const std::vector<glm::vec4> bins = skyBins(sky, edge);
    const Error e = error(gathered(kMany, [&](const glm::vec3& d) { return bins[skyBin(d, edge)].x; }));
    fmt::print("bins of 6 x {0} x {0}: irradiance off by {1:.2f} % of the mean (rms), the sum by {2:+.3f} %\n", edge,
               100 * e.rms, 100 * e.sum);
    if (edge != SKY_EDGE) continue;
    EXPECT_LT(e.rms, noise.rms);
    EXPECT_NEAR(e.sum, 0, 0.005);
  }
}

TEST_F(Skies, ReadsAPictureOfTheSphere) {
  const TemporaryFolder folder;
  const auto file = [&](glm::uvec2 size, const std::function<void(std::vector<glm::vec4>&)>& edit) {
    std::vector<glm::vec4> pixels(size_t{size.x} * size.y, glm::vec4(0.25f, 0.5f, 2e4f, 1));
    edit(pixels);
    writePfm(folder.path / "sky.pfm", size, pixels);
    return folder.path / "sky.pfm";
  };
  const auto nothing = [](std::vector<glm::vec4>&) {};
  const SkyImage small = readSky(file({8, 4}, nothing));
  EXPECT_EQ(small.texels->size, glm::uvec2(8, 4));
  EXPECT_EQ(small.texels->texels.at(31), glm::vec3(0.25f, 0.5f, 2e4f));
  EXPECT_EQ(small.sha256.size(), 64u);
  // What is larger than what is held is averaged.
  const SkyImage large = readSky(file({6144, 3072}, [](auto& p) { p[0].x = 4.25f; }));
  EXPECT_EQ(large.texels->size, glm::uvec2(3072, 1536));
  EXPECT_EQ(large.texels->texels.at(0).x, 1.25f);
  EXPECT_EQ(large.texels->texels.at(1).x, 0.25f);

  const auto refusal = [](const std::filesystem::path& path) {
    try {
      (void)readSky(path);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("(none)");
  };
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(contains(refusal(file({8, 4}, [&](auto& p) { p[3].y = nan, p[9].z = infinite, p[10].x = -1; })),
                       "sky.pfm: 1 NaN, 1 infinite and 1 negative of 32 texels, the first at 3, 0"));
  EXPECT_TRUE(contains(refusal(file({6, 4}, nothing)), "is 6 x 4 pixels: a sky is a picture of the whole sphere"));
  EXPECT_NE(refusal(folder.path / "gone.pfm"), "(none)");
  std::ofstream(folder.path / "bad.hdr") << "no picture";
  EXPECT_TRUE(contains(refusal(folder.path / "bad.hdr"), "bad.hdr"));
  if (!canDrawText()) return;  // no OpenImageIO: .pfm alone
  const std::vector<glm::u8vec4> bytes(32, glm::u8vec4(200));
  EXPECT_TRUE(
      contains(refusal(writeDisplay(folder.path / "eight", {8, 4}, bytes)), "holds integers, which end at white"));
}

TEST_F(Skies, PreethamsIsThePapers) {
  // The zenith's luminance and chromaticity by the paper's formulas (appendix A.2), written out anew.
  const auto zenith = [](const SkyTexels& sky) {
    glm::dvec3 sum(0);
    for (uint32_t x = 0; x < sky.size.x; ++x) sum += glm::dvec3(sky.texels[x]) / static_cast<double>(sky.size.x);
    return sum;
  };
  for (const double turbidity : {2.0, 3.0, 6.0})
    for (const double degrees : {15.0, 45.0, 80.0}) {
      const double s = glm::radians(degrees), chi = (4.0 / 9 - turbidity / 120) * (kPi - 2 * s);
      const double expected = (4.0453 * turbidity - 4.971) * std::tan(chi) - 0.2155 * turbidity + 2.4192;
      EXPECT_NEAR(preethamZenith(turbidity, s), expected, 1e-9);
      const SkyTexels sky = preethamSky(static_cast<float>(turbidity), {std::sin(s), std::cos(s), 0});
      const glm::dvec3 rgb = zenith(sky);
      // Luminance of Rec. 709, and x of its XYZ.
      const double y = 0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z;
      const double x = 0.4124 * rgb.x + 0.3576 * rgb.y + 0.1805 * rgb.z,
                   z = 0.0193 * rgb.x + 0.1192 * rgb.y + 0.9505 * rgb.z;
      const double s2 = s * s, s3 = s2 * s, t2 = turbidity * turbidity;
      const double zenithX = t2 * (0.00166 * s3 - 0.00375 * s2 + 0.00209 * s) +
                             turbidity * (-0.02903 * s3 + 0.06377 * s2 - 0.03202 * s + 0.00394) +
                             (0.11693 * s3 - 0.21196 * s2 + 0.06052 * s + 0.25886);
      EXPECT_NEAR(y / expected, 1, 0.01) << turbidity << " " << degrees;
      EXPECT_NEAR(x / (x + y + z), zenithX, 0.002) << turbidity << " " << degrees;
      // Nothing from below, and the brightest of what is seen is around the sun.
      EXPECT_EQ(sky.texels.back(), glm::vec3(0));
      for (const glm::vec3& t : sky.texels) EXPECT_TRUE(glm::all(glm::greaterThanEqual(t, glm::vec3(0))));
    }
  EXPECT_LT(preethamZenith(2, glm::radians(80.0)), preethamZenith(2, glm::radians(15.0)));

  // Coupled, its sun is the scene's; alone, that of the settings.
  SceneBuilder b = stillLife(0);
  b.sun(glm::normalize(glm::vec3(1, -1, 0)), 3);
  Settings s = under(SkySource::preetham);
  Pipeline p(context(), b.finish("sunny"), s);
  EXPECT_LT(glm::distance(glm::vec3(p.sky().model), glm::normalize(glm::vec3(-1, 1, 0))), 1e-5f);
  // And as bright as goes with it: by the paper's formulas such a sun, 45 degrees high in a haze of 3, brings 84.6 klx
  // to what faces it; thrice the sun brings thrice the sky.
  EXPECT_NEAR(p.sky().scale.x, 3 / 84.6, 1e-4);
  EXPECT_NEAR(preethamSun(2, 0), 106.8, 0.1);
  EXPECT_EQ(preethamSun(3, glm::radians(85.0)), preethamSun(3, glm::radians(100.0)));
  std::vector<Light> lights = p.scene().lights;
  lights.back().intensity = 1;
  p.setLights(lights);
  EXPECT_NEAR(p.sky().scale.x, 1 / 84.6, 1e-4);
  lights.back().intensity = 3;
  p.setLights(lights);
  const auto before = p.sky().texels;
  s.sky.intensity = 2;
  p.set(s);
  EXPECT_EQ(p.sky().texels, before) << "computed anew";
  s.sky.coupled = false, s.sky.elevation = 30, s.sky.azimuth = 90;
  p.set(s);
  EXPECT_LT(glm::distance(glm::vec3(p.sky().model), glm::vec3(std::sqrt(0.75f), 0.5f, 0)), 1e-5f);
}

TEST_F(Skies, PreethamsHasAGround) {
  // What the sky above brings to a floor, by a quadrature of its own over what is interpolated between the texels.
  const auto fromAbove = [](const Sky& sky) {
    glm::dvec3 sum(0);
    constexpr int kRows = 400, kColumns = 800;
    for (int i = 0; i < kRows; ++i)
      for (int k = 0; k < kColumns; ++k) {
        const double theta = kPi / 2 * (i + 0.5) / kRows, phi = 2 * kPi * (k + 0.5) / kColumns;
        const glm::dvec3 d(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi));
        sum += glm::dvec3(sky.radiance(glm::vec3(d))) * d.y * std::sin(theta);
      }
    return sum * (kPi / 2 / kRows) * (2 * kPi / kColumns);
  };
  // Closed forms: an even sky, and one that is as bright as it is high.
  SkyTexels high;
  high.size = {4, 256};
  high.texels.resize(4 * 256);
  for (size_t i = 0; i < high.texels.size() / 2; ++i) high.texels[i] = glm::vec3(high.direction(i).y);
  EXPECT_NEAR(irradianceFromAbove(high).x, 2 * kPi / 3, 1e-3);
  std::fill(high.texels.begin(), high.texels.end(), glm::vec3(2));
  EXPECT_NEAR(irradianceFromAbove(high).x, 2 * kPi, 1e-12);

  const SkySun sun{glm::normalize(glm::vec3(1, 1, 1)), {4, 3, 2}};
  for (const bool coupled : {false, true})
    for (const float albedo : {0.0f, 0.2f, 0.8f}) {
      SkySettings s;
      s.source = SkySource::preetham, s.ground = albedo, s.coupled = coupled, s.intensity = 0.5f;
      const Sky sky = makeSky(s, {.image = nullptr, .sun = sun});
      const glm::dvec3 brings = fromAbove(sky);
      // Half of the sky's light, hence half of the sun's on the ground, too: intensity is the ground's as the sky's.
      const glm::dvec3 all = brings + (coupled ? 0.5 * sun.towards.y * glm::dvec3(sun.irradiance) : glm::dvec3(0));
      for (const glm::vec3& d : {glm::vec3(0, -1, 0), glm::normalize(glm::vec3(3, -0.2f, 1))})
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(sky.radiance(d)[c], albedo / kPi * all[c], 1e-3 * all[c]) << coupled << " " << albedo;
      // With another intensity the texels are the same, with another ground they are others below the horizon.
      s.intensity = 3;
      EXPECT_EQ(makeSky(s, {.image = nullptr, .sun = sun}, &sky).texels, sky.texels);
      s.ground = 1;
      const Sky other = makeSky(s, {.image = nullptr, .sun = sun}, &sky);
      EXPECT_EQ(other.texels->texels.front(), sky.texels->texels.front());
      EXPECT_NE(other.texels->texels.back(), sky.texels->texels.back());
    }

  // Facets: what faces down gets pi times the ground's radiance, what faces up the irradiance from above.
  SceneBuilder b;
  const uint32_t black = b.material(glm::vec3(0));
  b.quad(black, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
  b.quad(black, {-1, -0.5f, -1}, {1, -0.5f, -1}, {1, -0.5f, 1}, {-1, -0.5f, 1});
  b.sun(-sun.towards, 3);
  b.camera({0, 0, 4}, {0, 0, 0});
  Settings settings = under(SkySource::preetham, 16, 512);
  settings.effects.matrix = EffectMode::on;  // black sheets show no H
  settings.sky.ground = 0.5f;
  Pipeline p(context(), b.finish("sheets"), settings);
  p.prepare();
  const HostFacets facets = hostFacets(context(), p.facets());
  const std::vector<glm::vec4> h = irradiance(p);
  const glm::dvec3 above = fromAbove(p.sky());
  const double below = 0.5 * (above.x + 3 * sun.towards.y);
  double up = 0, down = 0, upArea = 0, downArea = 0;
  for (size_t i = 0; i < facets.count(); ++i) {
    const bool isUp = facets.normal[i].y > 0;
    (isUp ? up : down) += facets.area[i] * h[i].x;
    (isUp ? upArea : downArea) += facets.area[i];
  }
  fmt::print("sheets: up {:.5f} of {:.5f}, down {:.5f} of {:.5f}\n", up / upArea, above.x, down / downArea, below);
  EXPECT_NEAR(up / upArea / above.x, 1, 0.01);
  EXPECT_NEAR(down / downArea / below, 1, 2e-3);
  // The view of it: from below the sheets show what they get from the ground, on their voxels.
  const std::vector<glm::vec4> view = picture(p, {32, 32}, VIEW_SKY_IRRADIANCE);
  EXPECT_NEAR(std::ranges::max(view, {}, [](const glm::vec4& v) { return v.x; }).x / below, 1, 0.05);
  // Drawn behind the scene, and by the path tracer, which lights a ground of its own.
  const std::vector<glm::vec4> seen = picture(p, {32, 32});
  EXPECT_NEAR(seen[31 * 32 + 3].x / (below / kPi), 1, 1e-3);
  if (!hasPathTracer()) return;
  const TracedPicture truth =
      makePathTracer(p.scene(), p.sky())->render(p.scene().cameras.at(0), {32, 32}, {.samples = 2, .centred = true});
  for (const size_t pixel : {31u * 32 + 3, 31u * 32 + 28, 27u * 32 + 16})
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(truth.lit.mean[pixel][c] / seen[pixel][c], 1, 1e-3) << pixel;
}

TEST_F(Skies, ASunThatTurnsHasItsShadowsAtOnce) {
  // Before the light is solved anew: pixels have the new sun with its own shadow map.
  Scene scene = stillLife(0).finish("still life");
  scene.sky = std::make_shared<SkyImage>(readSky(assets() / "evening.pfm"));
  Settings s = under(SkySource::image);
  s.view.light = static_cast<uint32_t>(scene.lights.size());  // the sky's sun
  Pipeline p(context(), scene, s);
  p.prepare();
  const auto shadows = [&] { return picture(p, {48, 48}, VIEW_SHADOW_MAP); };
  const auto before = shadows();
  s.sky.rotation = 120;
  p.set(s);
  const auto between = shadows();
  EXPECT_GE(p.device().lightValues.back().shadowLayer, 0);
  p.prepare();
  const auto after = shadows();
  EXPECT_FALSE(before == after);
  EXPECT_TRUE(between == after);
  // The same where the sun goes, and comes back.
  s.sky.source = SkySource::constant;
  p.set(s);
  p.prepare();
  EXPECT_FALSE(shadows() == after);
  s.sky.source = SkySource::image;
  p.set(s);
  EXPECT_TRUE(shadows() == after);
}

TEST_F(Skies, ASunIsTakenOutAndShinesAsALight) {
  const SkyImage image = readSky(assets() / "evening.pfm");
  ASSERT_TRUE(image.sun);
  // 24 degrees high in the west, 3, 2.3 and 1.5 W/m^2 (assets/make_evening.py), within half a texel.
  const glm::vec3 expected(-std::cos(glm::radians(24.0f)), std::sin(glm::radians(24.0f)), 0);
  EXPECT_GT(glm::dot(image.sun->towards, expected), std::cos(glm::radians(2.0f)));
  EXPECT_NEAR(image.sun->irradiance.x, 3, 0.02);
  EXPECT_NEAR(image.sun->irradiance.z, 1.5, 0.02);
  size_t changed = 0;
  for (size_t i = 0; i < image.whole->texels.size(); ++i) changed += image.whole->texels[i] != image.texels->texels[i];
  EXPECT_EQ(changed, 1u);
  // A bright half of the sky is no sun, nor is an even sky, nor a bright dot that brings nothing.
  EXPECT_FALSE(evening()->sun);
  auto flat = std::make_shared<SkyTexels>();
  flat->size = {64, 32};
  flat->texels.assign(64 * 32, glm::vec3(1));
  EXPECT_FALSE(withoutSun(flat).sun);
  flat->texels[64 * 3] = glm::vec3(22);
  EXPECT_FALSE(withoutSun(flat).sun);
  flat->texels[64 * 3] = glm::vec3(1e4f);
  EXPECT_TRUE(withoutSun(flat).sun);

  // It turns with the picture, and goes with the sky.
  Scene scene = stillLife(0).finish("still life");
  scene.sky = std::make_shared<SkyImage>(image);
  Settings s = under(SkySource::image);
  Pipeline p(context(), scene, s);
  ASSERT_EQ(p.device().lightValues.size(), scene.lights.size() + 1);
  s.sky.rotation = 90, s.sky.intensity = 2;
  p.set(s);
  p.prepare();
  const GpuLight& sun = p.device().lightValues.back();
  EXPECT_LT(glm::distance(-sun.direction, glm::vec3(image.sun->towards.z, image.sun->towards.y, -image.sun->towards.x)),
            0.01f);
  EXPECT_NEAR(sun.intensity.x, 6, 0.05);
  EXPECT_GE(sun.shadowLayer, 0);
  EXPECT_TRUE(p.plan().on(Effect::sun));
  s.sky.source = SkySource::constant;
  p.set(s);
  p.prepare();
  EXPECT_EQ(p.device().lightValues.size(), scene.lights.size());
}

/// A picture of a scene whose materials are Lambertian, by the program and by the path tracer: how far the mean is off,
/// and the mean difference of pixels, as shares.
struct Off {
  double mean = 0, pixels = 0;
};

class SkyPictures : public Skies {
 protected:
  Off off(Scene scene, const Settings& settings, std::shared_ptr<const SkyImage> image, glm::uvec2 size,
          uint32_t samples) {
    for (Material& m : scene.materials) {
      m.lambertian = true, m.metallic = 0, m.roughness = 1;
      m.metallicRoughnessTexture = {};
    }
    scene.sky = std::move(image);
    Pipeline p(context(), scene, settings);
    p.prepare();
    const std::vector<glm::vec4> found = picture(p, size);
    const TracedPicture truth =
        makePathTracer(scene, p.sky())->render(scene.cameras.at(0), size, {.samples = samples, .centred = true});
    const auto sum = [](const auto& v) { return double(v.x) + double(v.y) + double(v.z); };
    double all = 0, truthAll = 0, differences = 0;
    for (size_t i = 0; i < found.size(); ++i) {
      all += sum(found[i]), truthAll += sum(truth.lit.mean[i]);
      differences += std::abs(sum(found[i]) - sum(truth.lit.mean[i]));
    }
    return {all / truthAll - 1, differences / truthAll};
  }
};

TEST_F(SkyPictures, AreThePathTracers) {
  if (!hasPathTracer()) GTEST_SKIP() << "this build has no path tracer (IRAD_EMBREE)";
  // A sun of a texel, 35 degrees high: 2 W/m^2 from the west, which is where the room opens.
  auto withDisc = std::make_shared<SkyTexels>(*evening({1024, 512})->texels);
  withDisc->texels[156 * 1024 + 256] = glm::vec3(2 / (6.135e-3 * 6.136e-3 * 0.818));
  const auto sunny = std::make_shared<SkyImage>(withoutSun(withDisc));
  ASSERT_TRUE(sunny->sun);
  struct Case {
    const char* name;
    SkySource source;
    std::shared_ptr<const SkyImage> image;
    bool sun = false;
  };
  for (const Case& c :
       {Case{"constant", SkySource::constant, nullptr}, Case{"image", SkySource::image, evening()},
        Case{"image with a sun", SkySource::image, sunny}, Case{"preetham", SkySource::preetham, nullptr},
        Case{"preetham with the scene's sun", SkySource::preetham, nullptr, true}}) {
    Settings s = under(c.source, 48, 512);
    s.sky.ground = 0.5f;
    s.sky.rotation = 110;
    s.sky.elevation = 40, s.sky.azimuth = 100;
    SceneBuilder room = stillLife(/*light=*/0);
    if (c.sun) room.sun(glm::normalize(glm::vec3(0.5f, -0.8f, -1)), 3);
    const Off is = off(room.finish("still life"), s, c.image, {64, 48}, 256);
    fmt::print("{}: mean off by {:+.2f} %, mean |difference| {:.2f} %\n", c.name, 100 * is.mean, 100 * is.pixels);
    EXPECT_NEAR(is.mean, 0, 0.01) << c.name;
    // Where a sun shines the rims of its shadows count, of which the picture has few pixels to each.
    EXPECT_LT(is.pixels, c.image == sunny || c.sun ? 0.05 : 0.03) << c.name;
  }
}

TEST_F(SkyPictures, OfSponzaIsThePathTracers) {
  if (!hasPathTracer()) GTEST_SKIP() << "this build has no path tracer (IRAD_EMBREE)";
  const auto folder = sharedScenes();
  if (!folder) GTEST_SKIP() << "no shared scenes";
  LoadOptions options;
  options.lambertian = options.doubleSided = true;
  options.lights = std::vector<Light>{};
  const Off is = off(loadScene(*folder / "sponza/sponza.glb", options), under(SkySource::constant, 64, 64), nullptr,
                     {64, 48}, 256);
  fmt::print("Sponza: mean off by {:+.2f} %, mean |difference| {:.2f} %\n", 100 * is.mean, 100 * is.pixels);
  EXPECT_NEAR(is.mean, 0, 0.03);
}

TEST(SkyCommands, RefuseWhatIsNoSkyAndTakeWhatIs) {
  const TemporaryFolder folder;
  const auto render = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{"render", "box", "--size", "16x12", "--out", (folder.path / "out").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    for (const char* setting : {"voxel.resolution=10", "matrix.rays=16", "light.shadow_resolution=64"})
      arguments.insert(arguments.end(), {"--set", setting});
    return runIrad(arguments);
  };
  std::vector<glm::vec4> pixels(32, glm::vec4(1));
  pixels[9].y = -0.5f;
  writePfm(folder.path / "negative.pfm", {8, 4}, pixels);
  pixels[9].y = std::numeric_limits<float>::quiet_NaN();
  writePfm(folder.path / "nan.pfm", {8, 4}, pixels);
  std::ofstream(folder.path / "text.hdr") << "no picture";
  std::ofstream(folder.path / "short.pfm") << "PF\n8 4\n-1.0\n";
  struct Refused {
    const char *file, *says;
  };
  std::vector<Refused> refused{{"negative.pfm", "0 NaN, 0 infinite and 1 negative of 32 texels, the first at 1, 1"},
                               {"nan.pfm", "1 NaN, 0 infinite and 0 negative of 32 texels, the first at 1, 1"},
                               {"text.hdr", "text.hdr"},
                               {"short.pfm", "short.pfm"},
                               {"gone.pfm", "gone.pfm"}};
  if (canDrawText()) {  // OpenImageIO
    writeDisplay(folder.path / "eight", {8, 4}, std::vector<glm::u8vec4>(32, glm::u8vec4(200)));
    refused.push_back({"eight.png", "holds integers, which end at white"});
  }
  for (const auto& [file, says] : refused) {
    const RunResult run = render({"--sky", (folder.path / file).string()});
    EXPECT_EQ(run.status, 3) << file;
    EXPECT_TRUE(contains(run.err, file) && contains(run.err, says)) << run.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path / "out")) << file;
  }
  const RunResult none = render({"--set", "sky.source=image"});
  EXPECT_EQ(none.status, 2);
  EXPECT_TRUE(contains(none.err, "no picture of the sky was given (--sky FILE)")) << none.err;
  const RunResult evening = render({"--sky", "evening"});
  EXPECT_EQ(evening.status, 0) << evening.err;
  EXPECT_TRUE(contains(slurp(folder.path / "out/manifest.json"), "evening.pfm"));
}

TEST_F(SkyPictures, OfSponzaInTheSunIsThePathTracers) {
  if (!hasPathTracer()) GTEST_SKIP() << "this build has no path tracer (IRAD_EMBREE)";
  const auto folder = sharedScenes();
  if (!folder) GTEST_SKIP() << "no shared scenes";
  LoadOptions options;
  options.lambertian = options.doubleSided = true;
  Scene scene = loadScene(*folder / "sponza/sponza_small_lit_m.glb", options);
  const auto sun = std::ranges::find(scene.lights, LightType::Sun, &Light::type);
  ASSERT_NE(sun, scene.lights.end());
  for (Material& m : scene.materials) {
    m.lambertian = true, m.metallic = 0, m.roughness = 1;
    m.metallicRoughnessTexture = {};
  }
  // Preetham's, coupled to the scene's sun, above its ground. The sun's outlines and the textures are fine: the picture
  // has many pixels, and the path tracer samples all over its few.
  Pipeline p(context(), scene, under(SkySource::preetham, 64, 128));
  p.prepare();
  const std::vector<glm::vec4> found = picture(p, {512, 384});
  const TracedPicture truth =
      makePathTracer(scene, p.sky())->render(scene.cameras.at(0), {64, 48}, {.samples = 128, .centred = false});
  glm::dvec3 sum(0);
  for (const glm::vec4& v : found) sum += glm::dvec3(v) / static_cast<double>(found.size());
  const auto mean = [](const glm::dvec3& v) { return (v.x + v.y + v.z) / 3; };
  const double off = mean(sum) / mean(truth.lit.pictureMean) - 1,
               error = mean(truth.lit.pictureError) / mean(truth.lit.pictureMean);
  fmt::print("Sponza in the sun: mean off by {:+.2f} %, truth's standard error {:.2f} %\n", 100 * off, 100 * error);
  EXPECT_NEAR(off, 0, 0.03);
}

}  // namespace
}  // namespace irad::test::sky_suite
