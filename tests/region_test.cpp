// The part of a scene that has voxels (gi/region.h), and what lies outside of it (gi/outer.h): closed forms, the kernel
// against the host, and that scenes without such a part keep the whole.
#include "gi/region.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "gi/check/check.h"
#include "gi/check/families.h"
#include "gi/host_trace.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/outer.h"
#include "gi/pipeline.h"
#include "gi/ray_kernel.h"
#include "gi/subsystems.h"
#include "gi/traits.h"
#include "renderer/base/error.h"
#include "renderer/scene/material_edits.h"
#include "shaders/shared/pixel_emitters.h"
#include "shaders/shared/sky.h"
#include "tests/gi_fixture.h"

namespace irad::test::region_suite {
namespace {

void useBox(Settings& s, const glm::vec3& lo, const glm::vec3& hi) {
  applySetting(s, fmt::format("scene.region={},{},{},{},{},{}", lo.x, lo.y, lo.z, hi.x, hi.y, hi.z));
}

class Regions : public GiTest {
 protected:
  static Settings boxed(const glm::vec3& lo, const glm::vec3& hi, uint32_t resolution = 16, uint32_t rays = 256) {
    Settings s = at(resolution, rays);
    useBox(s, lo, hi);
    return s;
  }
  /// Mean by area of the first channel over the facets that face along `facing`, and how much of it each has at least
  /// and at most.
  struct Spread {
    double mean = 0, least = 1e30, most = 0;
  };
  Spread spread(Pipeline& p, const Buffer& of, const glm::vec3& facing) {
    const HostFacets facets = hostFacets(context(), p.facets());
    const std::vector<glm::vec4> v = downloadAs<glm::vec4>(context(), of);
    Spread s;
    double area = 0;
    for (size_t i = 0; i < facets.count(); ++i) {
      if (glm::dot(glm::vec3(facets.normal[i]), facing) < 0.99f) continue;
      s.mean += facets.area[i] * v[i].x, area += facets.area[i];
      s.least = std::min(s.least, double{v[i].x}), s.most = std::max(s.most, double{v[i].x});
    }
    s.mean /= area;
    return s;
  }
};

/// A box that faces outwards in the middle of a sphere of radius 100 that emits 1.
Scene boxUnderDome(bool doubleSided = false) {
  SceneBuilder b;
  const uint32_t box = b.material(glm::vec3(0.5f)), dome = b.material(glm::vec3(0), glm::vec3(1), doubleSided);
  b.box({box, box, box, box, box, box}, glm::vec3(-1), glm::vec3(1), /*inward=*/false);
  b.sphere(dome, glm::vec3(0), 100, /*inward=*/true, 4);  // few points lie outside
  return b.finish("box under a dome");
}

TEST_F(Regions, ADomeOutsideLightsWhatItIsAround) {
  for (const bool doubleSided : {false, true}) {
    Pipeline p(context(), boxUnderDome(doubleSided), boxed(glm::vec3(-1.5f), glm::vec3(1.5f)));
    p.prepare();
    EXPECT_NEAR(p.facets().grid.edge, 3.0 / 16, 1e-3);
    EXPECT_TRUE(p.facets().outer);
    for (int axis = 0; axis < 3; ++axis) {
      glm::vec3 facing(0);
      facing[axis] = 1;
      const Spread h = spread(p, p.lighting().indirect, facing), b = spread(p, p.lighting().radiosity, facing);
      // A convex body sees nothing else: F = 1, H = M. Every ray counts.
      EXPECT_NEAR(h.least, 1, 1e-5);
      EXPECT_NEAR(h.most, 1, 1e-5);
      EXPECT_NEAR(b.mean, 0.5, 1e-3);
    }
  }
}

/// What a lamp under the ceiling of a black room brings to its floor, at the points of the floor outside the region, is
/// Lambert's formula: no point is left dark because none of its few directions meets the lamp.
TEST_F(Regions, ALampLightsWhatLiesOutside) {
  const glm::vec3 lamp[] = {{-0.2f, 2.4f, -0.2f}, {0.2f, 2.4f, -0.2f}, {0.2f, 2.4f, 0.2f}, {-0.2f, 2.4f, 0.2f}};
  // The lamp lies in the region, or outside it, or is cut by its border.
  const std::pair<glm::vec3, glm::vec3> boxes[] = {
      {{-0.5f, 2, -0.5f}, {0.5f, 2.5f, 0.5f}}, {{1, 0, 1}, {2, 1, 2}}, {{0, 2, -0.5f}, {1, 2.5f, 0.5f}}};
  for (const auto& [lo, hi] : boxes) {
    SceneBuilder b;
    const uint32_t black = b.material(glm::vec3(0)), light = b.material(glm::vec3(0), glm::vec3(5));
    b.box({black, black, black, black, black, black}, {-3, 0, -3}, {3, 2.5f, 3}, /*inward=*/true);
    b.quad(light, lamp[0], lamp[1], lamp[2], lamp[3]);
    Pipeline p(context(), b.finish("lamp"), boxed(lo, hi));
    p.prepare();
    const Outer& outer = p.facets().outer;
    const std::vector<glm::vec4> found = downloadAs<glm::vec4>(context(), outer.irradiance);
    const std::vector<OuterPoint> points = downloadAs<OuterPoint>(context(), outer.points);
    const Scene& scene = p.scene();
    size_t onFloor = 0;
    double worst = 0;
    for (size_t i = 0; i < points.size(); ++i) {
      const uint32_t t = points[i].side, edges = outer.lattices[t].edges;
      glm::vec3 c[3];
      for (uint32_t k = 0; k < 3; ++k) c[k] = scene.positions[scene.indices[3 * t + k]];
      if (edges == 0 || c[0].y > scene.boundsMin.y || c[1].y > scene.boundsMin.y || c[2].y > scene.boundsMin.y)
        continue;
      const glm::vec2 s = glm::vec2(points[i].place & 0xFFFF, points[i].place >> 16) / static_cast<float>(edges);
      const glm::vec3 at = c[0] + s.x * (c[1] - c[0]) + s.y * (c[2] - c[0]) + glm::vec3(scene.origin);
      const Grid& grid = p.facets().grid;
      const glm::vec3 inGrid = (at - glm::vec3(scene.origin) - grid.origin) * grid.inverseEdge;
      if (glm::all(glm::greaterThan(inGrid, glm::vec3(-1))) &&
          glm::all(glm::lessThan(inGrid, glm::vec3(grid.dims) + 1.0f)))
        continue;  // it stands for what is around the grid
      const glm::vec3 up(0, 1, 0);
      const float f = triangleFormFactor(lamp[0] - at, lamp[1] - at, lamp[2] - at, up) +
                      triangleFormFactor(lamp[0] - at, lamp[2] - at, lamp[3] - at, up),
                  expected = 5 * f;
      worst = std::max(worst, std::abs(double{found[i].x} / expected - 1));
      ++onFloor;
    }
    fmt::print("region from {}: {} points, at worst {:.2g} off\n", lo.x, onFloor, worst);
    EXPECT_GT(onFloor, 50u);
    EXPECT_LT(worst, 0.1) << lo.x;
  }
}

TEST_F(Regions, WhatTheSunLightsOutsideIsReflectedOnce) {
  // Walls that stand above a large plane see it in half of their directions: H = rho D / 2. The roof sees none of it.
  SceneBuilder b;
  const uint32_t ground = b.material(glm::vec3(0.4f)), wall = b.material(glm::vec3(0));
  b.box({wall, wall, wall, wall, wall, wall}, {-1, 10, -1}, {1, 12, 1}, /*inward=*/false);
  b.quad(ground, {-2000, 0, 2000}, {2000, 0, 2000}, {2000, 0, -2000}, {-2000, 0, -2000});
  b.sun({0, -1, 0}, 3);
  Pipeline p(context(), b.finish("box above a plane"), boxed({-1.5f, 9, -1.5f}, {1.5f, 13, 1.5f}));
  p.prepare();
  EXPECT_NEAR(spread(p, p.lighting().indirect, {1, 0, 0}).mean, 0.5 * 0.4 * 3, 0.01);
  EXPECT_EQ(spread(p, p.lighting().indirect, {0, 1, 0}).most, 0);
  // The plane is lit but for the box's shadow, which is small against the lattice: below the box no point lies in it.
  EXPECT_NEAR(spread(p, p.lighting().indirect, {0, -1, 0}).mean, 0.4 * 3, 0.02);
}

/// A block on a ground of 2 km under an even sky: what the ground's points stand for, 31 m each, is lit as in the open,
/// that of the points below the block, too.
TEST_F(Regions, TheGroundAroundIsNotInTheShadeOfWhatStandsInside) {
  SceneBuilder b;
  const uint32_t ground = b.material(glm::vec3(0.4f)), block = b.material(glm::vec3(0.5f));
  b.box({block, block, block, block, block, block}, {-2, 0, -2}, {2, 3, 2}, /*inward=*/false);
  b.quad(ground, {-1000, 0, 1000}, {1000, 0, 1000}, {1000, 0, -1000}, {-1000, 0, -1000});
  Settings s = boxed({-6, 0, -6}, {6, 5, 6}, 24);
  s.sky.source = SkySource::constant;
  Pipeline p(context(), b.finish("block"), s);
  p.prepare();
  const std::vector<glm::vec4> found = downloadAs<glm::vec4>(context(), p.facets().outer.irradiance);
  const auto [least, most] = std::ranges::minmax(found, {}, &glm::vec4::x);
  EXPECT_GT(least.x, 0.8 * std::numbers::pi);
  EXPECT_NEAR(most.x, std::numbers::pi, 1e-4);
}

TEST_F(Regions, WhatLiesOutsideCastsShadowsInside) {
  for (const bool roof : {false, true}) {
    SceneBuilder b;
    const uint32_t grey = b.material(glm::vec3(0.5f));
    b.quad(grey, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}, 4);
    if (roof) b.quad(grey, {-60, 50, -60}, {60, 50, -60}, {60, 50, 60}, {-60, 50, 60});
    b.quad(grey, {200, 0, 1}, {201, 0, 1}, {201, 0, -1}, {200, 0, -1});
    b.sun({0.1f, -1, 0.2f}, 3);
    Pipeline p(context(), b.finish("roof"), boxed({-1.5f, -1, -1.5f}, {1.5f, 1, 1.5f}));
    p.prepare();
    const Spread d = spread(p, p.lighting().direct, {0, 1, 0});
    EXPECT_NEAR(d.mean, roof ? 0 : 3 / std::sqrt(1.05), 1e-3);
  }
}

TEST_F(Regions, TheSkyIsHiddenByWhatLiesOutside) {
  // Under a roof of 45 degrees all around the sky is 1/2 as bright: H = pi L cos^2(45).
  SceneBuilder b;
  const uint32_t black = b.material(glm::vec3(0), glm::vec3(0), /*doubleSided=*/true);
  b.quad(black, {-0.05f, 0, 0.05f}, {0.05f, 0, 0.05f}, {0.05f, 0, -0.05f}, {-0.05f, 0, -0.05f});
  b.zone(black, glm::vec3(0), 30, /*inward=*/true, 64, 0, 16);
  Settings s = boxed(glm::vec3(-1), glm::vec3(1), 8, 4096);
  s.sky.source = SkySource::constant;
  Pipeline p(context(), b.finish("under a cap"), s);
  p.prepare();
  EXPECT_NEAR(spread(p, p.lighting().indirect, {0, 1, 0}).mean, std::numbers::pi / 2, 0.02);
}

TEST_F(Regions, TheHostMeetsWhatTheKernelMeets) {
  if (!canTraceOnHost()) GTEST_SKIP() << "no Embree in this build (IRAD_EMBREE)";
  for (const char* name : {"object-on-plane", "under-dome", "room-in-desert"}) {
    const Family& family = *std::ranges::find(families(), std::string_view(name), &Family::name);
    Settings s = at(24, 64);
    s.scene.region.mode = RegionMode::automatic;
    const World w = world(familyMember(family, 1, 24).scene, s);
    ASSERT_TRUE(w.facets.outer) << name;
    const MatrixParams& params = s.matrix.gpu;
    std::vector<uint32_t> host(size_t{w.facets.count} * params.rays);
    makeHostTrace(context(), w.facets)->rows(params, 0, w.facets.count, host, 0, /*sky=*/true);
    const Buffer out(context().device, "hits", Subsystem::Matrix, 4 * host.size());
    Frame frame = context().begin();
    traceRows(frame, rayKernel(w.facets, w.field, params), params, 0, w.facets.count, out, /*sky=*/true);
    frame.submitAndWait();
    const std::vector<uint32_t> kernel = downloadAs<uint32_t>(context(), out);
    size_t differ = 0, outside = 0;
    for (size_t i = 0; i < host.size(); ++i) {
      outside += isOuter(host[i]);
      differ += host[i] != kernel[i];
    }
    fmt::print("{}: {} of {} rays differ, {} meet what lies outside\n", name, differ, host.size(), outside);
    EXPECT_GT(outside, host.size() / 500) << name;
    EXPECT_LE(differ, host.size() / 5000) << name;
  }
}

TEST_F(Regions, EditsOfWhatLiesOutsideAreSeenInside) {
  Pipeline p(context(), boxUnderDome(), boxed(glm::vec3(-1.5f), glm::vec3(1.5f)));
  p.prepare();
  const std::string dome = materialNames(p.scene()).at(1);
  p.setMaterials({{.material = dome, .emissionStrength = 2 * std::numbers::inv_pi_v<float>}});
  p.prepare();
  EXPECT_NEAR(spread(p, p.lighting().indirect, {0, 1, 0}).mean, 2, 1e-4);
}

TEST_F(Regions, TheTreeHoldsEveryTriangleOnce) {
  std::vector<glm::vec3> corners;
  for (uint32_t i = 0; i < 301; ++i)
    for (uint32_t k = 0; k < 3; ++k)
      corners.emplace_back(hashUint(9 * i + 3 * k) % 1000, hashUint(9 * i + 3 * k + 1) % 1000,
                           hashUint(9 * i + 3 * k + 2) % 1000);
  std::vector<uint32_t> order;
  const std::vector<OuterNode> nodes = outerTree(corners, order);
  std::vector<uint32_t> seen(301);
  for (uint32_t n = 0; n < nodes.size(); ++n) {
    EXPECT_GT(nodes[n].next, n);
    EXPECT_LE(nodes[n].next, nodes.size());
    const uint32_t first = nodes[n].leaf >> OUTER_LEAF_BITS, count = nodes[n].leaf & ((1u << OUTER_LEAF_BITS) - 1);
    for (uint32_t i = first; i < first + count; ++i) {
      ++seen.at(order.at(i));
      // Every node that is not passed by on the way holds it.
      for (uint32_t above = 0; above <= n; ++above)
        for (uint32_t k = 0; nodes[above].next > n && k < 3; ++k) {
          const glm::vec3& c = corners[3 * order[i] + k];
          EXPECT_TRUE(glm::all(glm::lessThan(nodes[above].lo, c)) && glm::all(glm::lessThan(c, nodes[above].hi)));
        }
    }
  }
  EXPECT_EQ(seen, std::vector<uint32_t>(301, 1));
}

TEST(Lattices, ThePointsOfATriangleAreFound) {
  const glm::vec3 a(1, 2, 3), b(11, 2, 4), c(0, 14, 3);
  for (const uint32_t edges : {1u, 2u, 7u, 64u}) {
    std::vector<uint32_t> seen(latticePoints(edges));
    for (uint32_t j = 0; j <= edges; ++j)
      for (uint32_t i = 0; i + j <= edges; ++i) {
        const glm::vec2 at = glm::vec2(i, j) / static_cast<float>(edges);
        const glm::vec2 found = barycentricOf(a, b, c, a + at.x * (b - a) + at.y * (c - a));
        EXPECT_NEAR(found.x, at.x, 1e-5);
        EXPECT_NEAR(found.y, at.y, 1e-5);
        EXPECT_EQ(nearestLattice(edges, found), latticeIndex(edges, i, j));
        ++seen.at(latticeIndex(edges, i, j));
      }
    EXPECT_EQ(seen, std::vector<uint32_t>(seen.size(), 1));
  }
}

TEST(RegionSettings, BadValuesAreNamed) {
  Settings s;
  for (const char* bad :
       {"scene.region=1,2,3", "scene.region=0,0,0,1,1,1,1", "scene.region=0,0,0,1,x,1", "scene.region=0,0,0,-1,1,1",
        "scene.region=0,0,0,1,0,1", "scene.region=some", "scene.region=0,0,0,1,nan,1", "scene.region=,,,,,"}) {
    const Settings before = s;
    try {
      applySetting(s, bad);
      ADD_FAILURE() << bad;
    } catch (const UsageError& error) {
      EXPECT_TRUE(contains(error.what(), "scene.region")) << error.what();
    }
    EXPECT_EQ(s, before);
  }
  applySetting(s, "scene.region=-1,-2,-3,1,2.5,3");
  Settings read;
  settingsFromJson(read, settingsToJson(s));
  EXPECT_EQ(read, s);
  EXPECT_EQ(read.scene.region.y1, 2.5f);
}

TEST(RegionRule, ABoxThatHoldsNothingIsAnError) {
  const Scene scene = boxUnderDome();
  Settings s;
  useBox(s, glm::vec3(300), glm::vec3(301));
  EXPECT_THROW((void)regionOf(scene, s), UsageError);
  EXPECT_TRUE(regionOrWhole(scene, s).whole);
  useBox(s, glm::vec3(-300), glm::vec3(301));
  EXPECT_TRUE(regionOf(scene, s).whole);
}

/// A small thing in a room of which a third of the light is reflected keeps the room; where the walls are black it does
/// not.
TEST(RegionRule, AutoKeepsWhatReflects) {
  Settings s;
  s.scene.region.mode = RegionMode::automatic;
  for (const float albedo : {0.0f, 0.33f}) {
    SceneBuilder b;
    const uint32_t wall = b.material(glm::vec3(albedo)), vase = b.material(glm::vec3(0.5f));
    b.box({wall, wall, wall, wall, wall, wall}, glm::vec3(-5), glm::vec3(5), /*inward=*/true);
    b.sphere(vase, glm::vec3(0, -4.8f, 0), 0.1f, /*inward=*/false, 16);
    b.camera({0.3, -4.7, 0.3}, {0, -4.8, 0});
    EXPECT_EQ(regionOf(b.finish("vase"), s).whole, albedo > 0) << albedo;
  }
}

/// Where there is a part that would have been taken, the line says why it is not, and how to have it.
TEST(RegionRule, WhyTheWholeIsKeptIsSaid) {
  // A ship under a dome: one that reflects lights itself.
  for (const float albedo : {0.0f, 0.015f, 0.5f}) {
    SceneBuilder b;
    const uint32_t dome = b.material(glm::vec3(albedo), glm::vec3(1)), ship = b.material(glm::vec3(0.5f));
    b.sphere(dome, glm::vec3(0), 100, /*inward=*/true, 16);
    b.sphere(ship, glm::vec3(0), 1, /*inward=*/false, 16);
    const Scene scene = b.finish("ship");
    Settings s;
    const std::string line = regionOf(scene, s).line;
    EXPECT_EQ(regionOf(scene, s).whole, albedo > 0.02f) << albedo;
    EXPECT_TRUE(line.starts_with(albedo > 0.02f ? "scene.region: whole, since 50 % of the light outside of "
                                                : "scene.region: voxels are made of "))
        << line;
    const size_t offered = line.find("scene.region=");
    EXPECT_EQ(offered != std::string::npos, albedo > 0.02f) << line;
    if (offered == std::string::npos) continue;
    applySetting(s, line.substr(offered, line.find(' ', offered) - offered));
    EXPECT_TRUE(regionOf(scene, s).line.starts_with("scene.region: voxels are made of -3,-3,-3,3,3,3 alone"))
        << regionOf(scene, s).line;
    s.scene.region.mode = RegionMode::whole;
    EXPECT_EQ(regionOf(scene, s).line, "");
    applyPreset(s, "thesis", true);
    s.scene.region = {};
    EXPECT_EQ(regionOf(scene, s).line, "");
  }
  // Something on a plane: from a tenth of it on the whole has voxels enough, and where the part would be three quarters
  // of it nobody waits for one.
  for (const float radius : {9.0f, 11.0f, 40.0f}) {
    SceneBuilder b;
    const uint32_t grey = b.material(glm::vec3(0.5f));
    b.quad(grey, {-100, 0, 100}, {100, 0, 100}, {100, 0, -100}, {-100, 0, -100});
    b.sphere(grey, glm::vec3(0, radius, 0), radius, /*inward=*/false, 16);
    const Scene scene = b.finish("ball");
    const std::string line = regionOf(scene, Settings()).line;
    EXPECT_EQ(regionOf(scene, Settings()).whole, radius > 10) << radius;
    EXPECT_TRUE(line.starts_with(radius < 10   ? "scene.region: voxels are made of "
                                 : radius < 20 ? "scene.region: whole, since its detail is 0.11 of it, more than 0.1"
                                               : ""))
        << line;
    EXPECT_EQ(line.empty(), radius > 20) << line;
  }
}

/// A thing on a black plane, beside it a small lamp that rays would rarely meet: it is kept inside, with the whole
/// where that takes it; a dome is not, which all rays meet.
TEST(RegionRule, AutoKeepsSmallLampsInside) {
  for (const float away : {0.0f, 8.0f, 90.0f}) {
    SceneBuilder b;
    const uint32_t black = b.material(glm::vec3(0)), thing = b.material(glm::vec3(0.5f)),
                   lamp = b.material(glm::vec3(0), glm::vec3(50)), dome = b.material(glm::vec3(0), glm::vec3(1));
    b.quad(black, {-100, 0, 100}, {100, 0, 100}, {100, 0, -100}, {-100, 0, -100});
    b.sphere(thing, glm::vec3(0, 1, 0), 1, /*inward=*/false, 16);
    b.camera({2, 1, 2}, {0, 1, 0});
    if (away > 0)
      b.quad(lamp, {away, 1, -0.2f}, {away, 1, 0.2f}, {away, 1.4f, 0.2f}, {away, 1.4f, -0.2f});
    else
      b.sphere(dome, glm::vec3(0), 100, /*inward=*/true, 16);
    const Scene scene = b.finish("lamp");
    const SceneRegion region = regionOf(scene, Settings());
    EXPECT_FALSE(region.whole) << away;
    const float end = region.hi.x + static_cast<float>(scene.origin.x);
    EXPECT_TRUE(away > 0 ? end >= away : end < 5) << end;
  }
}

/// Cameras are inside; where the box around them saves less than a quarter of the voxels' edge it is the whole.
TEST(RegionRule, AutoTakesTheWholeWhereThatCostsLittle) {
  for (const float apart : {140.0f, 160.0f}) {
    SceneBuilder b;
    const uint32_t black = b.material(glm::vec3(0)), thing = b.material(glm::vec3(0.5f));
    b.quad(black, {-100, 0, 100}, {100, 0, 100}, {100, 0, -100}, {-100, 0, -100});
    b.sphere(thing, glm::vec3(0, 1, 0), 1, /*inward=*/false, 16);
    for (const float side : {-0.5f, 0.5f}) b.camera({side * apart, 1, 0}, {0, 1, 0});
    EXPECT_EQ(regionOf(b.finish("thing"), Settings()).whole, apart > 150) << apart;
  }
}

/// The box that a scene brings along is that of scene.region=auto alone, and a run's settings say so without it.
TEST(RegionRule, AutoTakesTheScenesBox) {
  Scene scene = boxUnderDome();
  scene.region = RegionBox{glm::vec3(-3), glm::vec3(4)};
  Settings s;
  SceneRegion box{glm::vec3(-3), glm::vec3(4), false};
  box.line = describe(scene, box);
  EXPECT_EQ(regionOf(scene, s), box);
  const Settings said = withRegionOf(scene, s);
  EXPECT_EQ(said.scene.region, (RegionSettings{RegionMode::box, -3, -3, -3, 4, 4, 4}));
  s.scene.region.mode = RegionMode::whole;
  EXPECT_TRUE(regionOf(scene, s).whole);
  EXPECT_EQ(withRegionOf(scene, s), s);
  s = said;
  s.scene.region.x1 = 5;
  EXPECT_EQ(regionOf(scene, s).hi, glm::vec3(5, 4, 4)) << "what is set goes before it";
  applyPreset(s, "thesis", true);
  s.scene.region = {};
  EXPECT_TRUE(regionOf(scene, s).whole);
  scene.region = RegionBox{glm::vec3(300), glm::vec3(301)};
  scene.sidecar = "X.irad.json";
  try {
    (void)regionOf(scene, Settings());
    ADD_FAILURE() << "it holds nothing";
  } catch (const UsageError& error) {
    EXPECT_TRUE(contains(error.what(), "X.irad.json: region=300,300,300,301,301,301")) << error.what();
  }
}

TEST_F(Regions, AnotherBoxBuildsAnewAndBackIsAsItWas) {
  Pipeline p(context(), boxUnderDome(), at(16, 64));
  p.prepare();
  const float byItself = p.facets().grid.edge;
  p.setRegion(RegionBox{glm::vec3(-2), glm::vec3(2)});
  EXPECT_EQ(p.due(p.settings()), Redo::Voxels);
  p.prepare();
  EXPECT_NEAR(p.facets().grid.edge, 4.0 / 16, 1e-3);
  p.setRegion({});
  p.prepare();
  EXPECT_EQ(p.facets().grid.edge, byItself);
  // A box that nobody asks for calls for nothing.
  Settings whole = p.settings();
  whole.scene.region.mode = RegionMode::whole;
  p.set(whole);
  p.prepare();
  p.setRegion(RegionBox{glm::vec3(-2), glm::vec3(2)});
  EXPECT_GT(p.due(p.settings()), Redo::Matrix);
}

/// Users get a part where that is small without asking for it, and with the thesis's preset the whole.
TEST(RegionRule, ThePartIsTheDefault) {
  const Scene scene =
      familyMember(*std::ranges::find(families(), std::string_view("under-dome"), &Family::name), 1, 64).scene;
  for (const bool cpu : {false, true})
    for (const std::string& preset : presetNames()) {
      Settings s = defaultSettings(cpu);
      EXPECT_FALSE(regionOf(scene, s).whole);
      applyPreset(s, preset, cpu);
      EXPECT_EQ(regionOf(scene, s).whole, preset == "thesis") << preset;
    }
}

/// An edit in the window moves no voxels by itself: the rule goes by the file's materials.
TEST(RegionRule, EditsOfMaterialsLeaveTheRegion) {
  Scene scene = boxUnderDome();
  const SceneRegion before = regionOf(scene, Settings());
  EXPECT_FALSE(before.whole);
  for (const std::string& name : materialNames(scene)) {
    replaceMaterialEdits(scene, {{.material = name, .baseColor = glm::vec3(1), .emissionStrength = 0.0f}});
    EXPECT_EQ(regionOf(scene, Settings()), before) << name;
  }
}

TEST(RegionRule, WhatIsLeftOutIsSaidInFewDigits) {
  SceneRegion region{glm::vec3(-1.0f / 3, 1.85966e-7f, -2e-9f), glm::vec3(1.0f / 3, 2, 1234.5678f), false};
  Scene scene;
  EXPECT_TRUE(contains(describe(scene, region), " -0.3,0,0,0.3,2,1234.6 ")) << describe(scene, region);
  region = {glm::vec3(-1.0f / 3), glm::vec3(1.0f / 3, 1.0f / 3, 1.85966e-7f), false};
  EXPECT_TRUE(contains(describe(scene, region), " -0.33333,-0.33333,-0.33333,0.33333,0.33333,0 "))
      << describe(scene, region);
}

/// The rule takes a part of what has one, around it, and the whole of everything else.
TEST(RegionRule, AutoFindsWhatIsSmall) {
  Settings s;
  s.scene.region.mode = RegionMode::automatic;
  for (const Family& family : families())
    for (uint64_t seed = 1; seed <= 12; ++seed) {
      const Scene scene = familyMember(family, seed, 64).scene;
      const SceneRegion region = regionOf(scene, s);
      EXPECT_EQ(region.whole, !family.outside) << family.name << " " << seed;
      if (!family.outside) continue;
      const glm::vec3 size = region.hi - region.lo;
      EXPECT_LT(std::max({size.x, size.y, size.z}), 22) << family.name << " " << seed;
      for (const Camera& camera : scene.cameras) {
        const glm::vec3 at = glm::clamp(glm::vec3(camera.position - scene.origin), scene.boundsMin, scene.boundsMax);
        EXPECT_TRUE(glm::all(glm::greaterThanEqual(at, region.lo)) && glm::all(glm::lessThanEqual(at, region.hi)))
            << family.name << " " << seed;
      }
      EXPECT_TRUE(contains(describe(scene, region), "scene.region")) << describe(scene, region);
    }
}

/// So that ordinary scenes keep their bits.
TEST(RegionRule, TheDefaultTakesTheWholeOfOrdinaryScenes) {
  const Settings s;
  size_t scenes = 0;
  for (const CheckCase& c : checkCases()) {
    if (c.scene == nullptr) continue;
    if (std::ranges::any_of(families(),
                            [&](const Family& f) { return f.outside && c.name == std::string_view(f.name); }))
      continue;
    EXPECT_TRUE(regionOf(c.scene(), s).whole) << c.name;
    ++scenes;
  }
  EXPECT_GT(scenes, 20u);
  std::vector<std::filesystem::path> folders{assets()};
  if (const auto shared = sharedScenes())
    for (const char* folder : {"analytic", "cornell", "real", "sponza", "variants"})
      folders.push_back(*shared / folder);
  for (const std::filesystem::path& folder : folders)
    for (const auto& file : std::filesystem::directory_iterator(folder)) {
      const std::string kind = file.path().extension();
      const bool refused = file.path().stem().string().starts_with("REFUSE");
      if ((kind != ".glb" && kind != ".gltf") || refused) continue;
      EXPECT_TRUE(regionOf(loadScene(file.path()), s).whole) << file.path();
    }
}

}  // namespace
}  // namespace irad::test::region_suite
