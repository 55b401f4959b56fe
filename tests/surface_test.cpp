// Facets as classes of surfels, and rays that meet the triangles (docs/method.md 4, 5): against the scene's own
// triangles, closed forms, and 0.
#include "gi/surface.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <span>
#include <utility>

#include "gi/check/families.h"
#include "gi/host_facets.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/oracle/rays.h"
#include "gi/pipeline.h"
#include "gi/ray_kernel.h"
#include "gi/scatter.h"
#include "gi/scene_shape.h"
#include "gi/subsystems.h"
#include "renderer/base/error.h"
#include "renderer/frame/workgroups.h"
#include "renderer/targets.h"
#include "shaders/shared/trace.h"
#include "tests/gi_fixture.h"

namespace irad::test::surface_suite {
namespace {

double triangleArea(const Scene& scene, size_t t) {
  const auto corner = [&](size_t i) { return glm::dvec3(scene.positions[scene.indices[3 * t + i]]); };
  return 0.5 * glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
}

class SurfaceTest : public GiTest {
 protected:
  static Settings triangles(uint32_t resolution, uint32_t rays = 128) {
    Settings s = at(resolution, rays);
    s.specular.mode = SpecularMode::off;
    return s;
  }
  Pipeline& prepare(Scene scene, const Settings& settings) {
    pipeline_ = std::make_unique<Pipeline>(context(), std::move(scene), settings);
    pipeline_->prepare();
    return *pipeline_;
  }
  /// Values per facet, by what `key` makes of position and normal: their area-weighted means.
  template <class Key>
  auto means(const Pipeline& p, const Buffer& values, Key key) {
    const HostFacets f = hostFacets(context(), p.facets());
    const std::vector<glm::vec3> v = perFacet(context(), p.facets(), values);
    std::map<decltype(key(glm::dvec3(), glm::dvec3())), std::pair<double, double>> sums;
    for (size_t i = 0; i < f.count(); ++i) {
      auto& [sum, area] = sums[key(f.position[i], f.normal[i])];
      sum += f.area[i] * double{v[i].x};
      area += f.area[i];
    }
    for (auto& [k, sum] : sums) sum.first /= sum.second;
    return sums;
  }
  FacetList listedBy(ListedBy by, const World& w) {
    return listFacets(context(), *w.device, shapeOf(*w.scene, w.settings), w.settings, by);
  }
  /// To the bit.
  void expectSame(const FacetList& a, const FacetList& b) {
    const auto bytes = [&](const Buffer& buffer) { return download(context(), buffer); };
    ASSERT_EQ(a.count, b.count);
    const Surface &s = a.surface, &t = b.surface;
    EXPECT_EQ(bytes(a.voxel), bytes(b.voxel));
    EXPECT_EQ(bytes(a.shape), bytes(b.shape));
    EXPECT_EQ(bytes(a.albedo), bytes(b.albedo));
    EXPECT_EQ(bytes(a.area), bytes(b.area));
    EXPECT_EQ(bytes(s.sides), bytes(t.sides));
    EXPECT_EQ(bytes(s.surfels), bytes(t.surfels));
    EXPECT_EQ(bytes(s.linkMasks), bytes(t.linkMasks));
    EXPECT_EQ(bytes(s.firstLinks), bytes(t.firstLinks));
    EXPECT_EQ(bytes(s.links), bytes(t.links));
    // Not all words of these are written.
    const oracle::Facets f = oracleFacets(context(), a), g = oracleFacets(context(), b);
    for (uint32_t piece = 0; piece < f.sides.size(); ++piece) {
      if ((f.sides[piece] & PIECE_CUT) == 0) continue;
      ASSERT_TRUE(std::ranges::equal(f.cutsOf(piece).triangles, g.cutsOf(piece).triangles)) << piece;
      ASSERT_TRUE(std::ranges::equal(f.cutsOf(piece).parts, g.cutsOf(piece).parts)) << piece;
    }
    for (size_t i = 0; i < f.surfels.size(); ++i)
      ASSERT_TRUE(f.surfels[i].triangle == g.surfels[i].triangle && f.surfels[i].place == g.surfels[i].place) << i;
  }
  static constexpr uint32_t kPixels = 64;
  std::vector<glm::vec4> draw(Pipeline& pipeline, const glm::vec3& from, const glm::vec3& to, View view) {
    Camera camera;
    camera.position = from;
    camera.orientation = glm::quatLookAt(glm::normalize(to - from), glm::vec3(0, 1, 0));
    Targets targets(context(), {kPixels, kPixels});
    Frame frame = context().begin();
    pipeline.render(frame, camera, view, targets);
    frame.submitAndWait();
    const std::vector<std::byte> raw = download(context(), targets.linear);
    std::vector<glm::vec4> out(size_t{kPixels} * kPixels);
    std::memcpy(out.data(), raw.data(), raw.size());
    return out;
  }
  std::unique_ptr<Pipeline> pipeline_;
};

TEST_F(SurfaceTest, FacetsHaveTheAreaAndThePowerOfTheirTriangles) {
  for (const bool turned : {false, true}) {
    SceneBuilder b;
    const glm::mat3 turn =
        turned ? glm::mat3(glm::rotate(glm::mat4(1), 0.6f, glm::normalize(glm::vec3(1, 2, 3)))) : glm::mat3(1);
    const uint32_t wall = b.material(glm::vec3(0.5f)), lamp = b.material(glm::vec3(0.2f), glm::vec3(3)),
                   sheet = b.material(glm::vec3(0.7f), glm::vec3(0), /*doubleSided=*/true);
    b.box({wall, wall, wall, wall, wall, lamp}, glm::vec3(-1), glm::vec3(1), /*inward=*/true, turn);
    b.sphere(wall, {0.3f, -0.2f, 0}, 0.35f, /*inward=*/false, 12);
    b.sphere(lamp, {-0.5f, 0.5f, 0.1f}, 0.03f, /*inward=*/false, 6);  // less than a voxel
    b.quad(sheet, {-0.6, -0.5, 0.5}, {0.2, -0.5, 0.5}, {0.2, -0.3, -0.6}, {-0.6, -0.3, -0.6});
    const Scene scene = b.finish("areas");
    std::map<uint32_t, double> area;  // by material, both sides where there are two
    double power = 0;
    for (const Draw& draw : scene.draws)
      for (size_t t = draw.firstIndex / 3; t < (draw.firstIndex + draw.indexCount) / 3; ++t) {
        const double a = triangleArea(scene, t);
        area[draw.material] += draw.material == sheet ? 2 * a : a;
        if (draw.material == lamp) power += 3 * a;
      }
    for (const uint32_t resolution : {12u, 29u}) {
      const World w = world(scene, triangles(resolution));
      const HostFacets f = hostFacets(context(), w.facets);
      double all = 0, emitted = 0, sheets = 0;
      for (size_t i = 0; i < f.count(); ++i) {
        all += f.area[i];
        emitted += f.area[i] * double{f.emission[i].x};
        if (f.albedo[i].x > 0.6f) sheets += f.area[i];
      }
      EXPECT_NEAR(all / (area[wall] + area[lamp] + area[sheet]), 1, 1e-3) << resolution;
      EXPECT_NEAR(emitted / power, 1, 1e-3) << resolution;
      EXPECT_NEAR(sheets / area[sheet], 1, 0.02) << resolution;  // some share a facet with others
    }
  }
}

TEST_F(SurfaceTest, TheAreaOfAFaceThatIsThereTwiceCountsOnce) {
  struct Repeat {
    const char* name;
    uint32_t material;
    bool first;          ///< it comes before the face in the file
    double area, power;  ///< of the quad's facets, 1 m^2 with M = 3
  };
  constexpr uint32_t kLamp = 1, kGrey = 2, kSheet = 3, kMasked = 4;
  const glm::vec3 p[4] = {{-0.5f, 0.1f, 0.5f}, {0.5f, 0.1f, 0.5f}, {0.5f, 0.15f, -0.5f}, {-0.5f, 0.15f, -0.5f}};
  const double size = std::sqrt(1 + 0.05 * 0.05);
  for (const Repeat& repeat : {Repeat{"none", 0, false, 1, 1},
                               {"the same", kLamp, false, 1, 1},
                               {"grey", kGrey, false, 1, 1},
                               {"grey first", kGrey, true, 1, 0},
                               {"shows its back", kSheet, false, 3, 1},
                               {"shows its back, first", kSheet, true, 2, 0},
                               {"has holes", kMasked, false, 1, 1},
                               {"has holes, first", kMasked, true, 2, 1}})
    for (const uint32_t turn : {0u, 1u, 2u}) {
      SceneBuilder b;
      const auto add = [&](uint32_t material, uint32_t turned) {  // each triangle from that corner on
        const glm::vec3 t[2][3] = {{p[0], p[1], p[2]}, {p[0], p[2], p[3]}};
        for (const auto& c : t) {
          const glm::vec3 last = c[(turned + 2) % 3];
          b.quad(material, c[turned % 3], c[(turned + 1) % 3], last, last);
        }
      };
      b.material(glm::vec3(0.5f));
      b.material(glm::vec3(0.2f), glm::vec3(3));
      b.material(glm::vec3(0.7f));
      b.material(glm::vec3(0.7f), glm::vec3(0), /*doubleSided=*/true);
      b.material(glm::vec3(0.7f));
      b.edit(kMasked).alpha = AlphaMode::Mask;
      b.quad(0, {-1, -1, 1}, {1, -1, 1}, {1, -1, -1}, {-1, -1, -1});
      add(kLamp, 0);
      if (repeat.material != 0) add(repeat.material, turn);
      Scene scene = b.finish("repeat");
      if (repeat.first) reverseTriangles(scene);
      const World w = world(std::move(scene), triangles(17, 32));
      const HostFacets f = hostFacets(context(), w.facets);
      double area = 0, power = 0;
      for (size_t i = 0; i < f.count(); ++i) {
        if (f.position[i].y - w.scene->boundsMin.y < 0.5) continue;
        area += f.area[i];
        power += f.area[i] * double{f.emission[i].x};
      }
      EXPECT_NEAR(area, repeat.area * size, 1e-3) << repeat.name << ", from corner " << turn;
      EXPECT_NEAR(power, 3 * repeat.power * size, 3e-3) << repeat.name << ", from corner " << turn;
    }
}

TEST_F(SurfaceTest, RaysMeetTheFirstOfAllTriangles) {
  // Of every triangle of the scene, in double precision, without voxels.
  const Settings settings = triangles(20, 16);
  const World w = world(furnishedRoom(), settings);
  const MatrixParams& params = settings.matrix.gpu;
  const Buffer out(context().device, "hits", Subsystem::Matrix, 4ull * w.facets.count * params.rays);
  Frame frame = context().begin();
  traceRows(frame, rayKernel(w.facets, w.field, params), params, 0, w.facets.count, out);
  frame.submitAndWait();
  const std::vector<uint32_t> met = downloadAs<uint32_t>(context(), out);
  const oracle::Facets host = oracleFacets(context(), w.facets);
  const HostFacets facets = hostFacets(context(), w.facets);
  size_t wrong = 0, compared = 0;
  for (uint32_t f = 0; f < w.facets.count; f += 3)
    for (uint32_t k = 0; k < oracle::raysOf(host, f, params); ++k) {
      const oracle::Ray ray = oracle::facetRay(host, f, k, params);
      const auto [first, nearest, edge] = oracle::firstOfAll(host, ray);
      if (edge < 1e-4) continue;  // a decision for double precision
      ++compared;
      const uint32_t got = met[size_t{f} * params.rays + k];
      if (first == oracle::kNoTriangle) {
        wrong += got != TRACE_ESCAPED;
        continue;
      }
      const glm::dvec3 point = ray.origin + nearest * ray.direction;
      const glm::dvec3 a = host.corner(first, 0);
      const glm::dvec3 n = glm::normalize(glm::cross(host.corner(first, 1) - a, host.corner(first, 2) - a));
      if (got == TRACE_BLOCKED) {  // the back of a single-sided face
        wrong += glm::dot(n, ray.direction) < 0;
        continue;
      }
      if (got > TRACE_LAST_FACET) {
        ++wrong;
        continue;
      }
      const glm::dvec3 cell(facets.voxel[got]);
      const bool inCell =
          glm::all(glm::greaterThan(point, cell - 1e-3)) && glm::all(glm::lessThan(point, cell + 1.001));
      const double alike = std::abs(glm::dot(n, facets.normal[got]));
      wrong += !inCell || glm::dot(facets.normal[got], ray.direction) > 0.5 || alike < 0.5;
    }
  fmt::print("{} of {} rays met something else\n", wrong, compared);
  EXPECT_GT(compared, 10000u);
  EXPECT_LE(wrong, compared / 2000);
}

TEST_F(SurfaceTest, FurnacesAreEvenlyLit) {
  for (Scene (*make)(float) : {furnaceBox, furnaceTilted, furnaceSphere}) {
    const Pipeline& p = prepare(make(0.8f), triangles(24));
    const auto mean = means(p, p.lighting().radiosity, [](auto, auto) { return 0; });
    EXPECT_NEAR(mean.at(0).first * 0.2, 1, 0.01) << p.scene().path;
    EXPECT_LT(std::abs(p.lighting().report.energy->imbalance()), 0.002);
  }
}

/// Two rooms in one shell, 32 x 12 x 12: the left one's end is a lamp. Between them, from x = .3 on, a wall of this
/// thickness, which stands on the floor that both share; on its right, unless `sheet` is false, another one,
/// single-sided, .3 voxel away. Turned, so that no face is along an axis.
const glm::mat3 kTurn(glm::rotate(glm::mat4(1), 0.5f, glm::normalize(glm::vec3(2, 1, 3))));
constexpr float kWallAt = 0.3f;
SceneBuilder litAndDarkRoom(float thickness, bool sheet, bool mirrors = false) {
  SceneBuilder b;
  const uint32_t wall = b.material(glm::vec3(0.6f)), lamp = b.material(glm::vec3(0.5f), glm::vec3(5));
  if (mirrors) {
    b.edit(wall).lambertian = false;
    b.edit(wall).metallic = 0.5f;
  }
  b.box({lamp, wall, wall, wall, wall, wall}, {-16, -6, -6}, {16, 6, 6}, /*inward=*/true, kTurn);
  const float to = kWallAt + thickness;
  b.box({wall, wall, wall, wall, wall, wall}, {kWallAt, -7, -7}, {to, 7, 7}, /*inward=*/false, kTurn);
  const auto at = [&](float x, float y, float z) { return kTurn * glm::vec3(x, y, z); };
  if (sheet) b.quad(wall, at(to + 0.3f, -7, -7), at(to + 0.3f, 7, -7), at(to + 0.3f, 7, 7), at(to + 0.3f, -7, 7));
  return b;
}

TEST_F(SurfaceTest, NothingComesThroughThinWalls) {
  const float n = 32;
  for (const float thickness : {0.2f, 1.1f}) {
    SceneBuilder b = litAndDarkRoom(thickness, /*sheet=*/true);
    const float to = kWallAt + thickness;
    const Pipeline& p = prepare(b.finish("two rooms"), triangles(static_cast<uint32_t>(n)));
    const glm::mat3 back = glm::transpose(kTurn);
    const HostFacets f = hostFacets(context(), p.facets());
    const std::vector<glm::vec3> h = perFacet(context(), p.facets(), p.lighting().indirect);
    const std::vector<glm::vec3> blurred = perFacet(context(), p.facets(), p.lighting().shaded());
    double dark = 0, darkBlurred = 0, lit = 0;
    size_t right = 0;
    for (size_t i = 0; i < f.count(); ++i) {
      const glm::vec3 at = back * glm::vec3(f.position[i]);
      if (at.x > to + 0.35f && std::abs(at.y) < 6.1f && std::abs(at.z) < 6.1f) {
        dark = std::max(dark, double{h[i].x});
        darkBlurred = std::max(darkBlurred, double{blurred[i].x});
        ++right;
      } else if (at.x < 0) {
        lit = std::max(lit, double{h[i].x});
      }
    }
    EXPECT_GT(right, 1000u);
    EXPECT_GT(lit, 1);
    EXPECT_EQ(dark, 0) << thickness;
    EXPECT_EQ(darkBlurred, 0) << thickness;
  }
}

TEST_F(SurfaceTest, TheBlurKeepsConstantsAndHasTheWeightsOfATent) {
  // A floor of 16 x 16 voxels, far from its rim; and one bright facet in the middle, which reaches its 3 x 3
  // neighbours with 4, 2, 1 of 16.
  SceneBuilder b;
  b.quad(b.material(glm::vec3(0.5f)), {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
  b.sun({0, -1, 0}, 1);
  Settings settings = triangles(16, 32);
  settings.effects.blur = EffectMode::on;
  const Pipeline& p = prepare(b.finish("floor"), settings);
  const FacetList& list = p.facets();
  ASSERT_EQ(list.count, 256u);
  const std::vector<uint32_t> voxel = downloadAs<uint32_t>(context(), list.voxel);
  std::vector<glm::vec4> h(list.count, glm::vec4(3));
  Lighting light = makeLighting(context(), list, settings);
  const auto blurred = [&] {
    upload(context(), light.indirect, std::as_bytes(std::span(h)));
    Frame frame = context().begin();
    scatter(frame, list, FormFactors{}, light, settings);  // noise unknown: the mean
    frame.submitAndWait();
    return downloadAs<glm::vec4>(context(), light.shaded());
  };
  for (const glm::vec4& value : blurred()) EXPECT_FLOAT_EQ(value.x, 3);
  const auto at = [&](int x, int z) {
    for (uint32_t i = 0; i < list.count; ++i)
      if (const glm::uvec3 v = unpackVoxel(voxel[i]); v.x == 8u + x && v.z == 8u + z) return i;
    return list.count;
  };
  h.assign(list.count, glm::vec4(0));
  h[at(0, 0)] = glm::vec4(16);
  const std::vector<glm::vec4> spike = blurred();
  // Areas, by which they are weighted, differ by rounding.
  EXPECT_NEAR(spike[at(0, 0)].x, 4, 1e-3);
  EXPECT_NEAR(spike[at(1, 0)].x, 2, 1e-3);
  EXPECT_NEAR(spike[at(0, -1)].x, 2, 1e-3);
  EXPECT_NEAR(spike[at(1, 1)].x, 1, 1e-3);
  EXPECT_EQ(spike[at(2, 0)].x, 0);
}

TEST_F(SurfaceTest, ReflectionsShowNothingFromBehindThinWalls) {
  // Of every roughness that traces, beside the wall and along it: exactly black in the dark room.
  for (const SpecularMode mode : {SpecularMode::compute, SpecularMode::fragment})
    for (const float roughness : {0.0f, 0.35f}) {
      SceneBuilder b = litAndDarkRoom(0.2f, /*sheet=*/false, /*mirrors=*/true);
      b.edit(0).roughness = roughness;
      Settings settings = triangles(32, 64);
      settings.specular.mode = mode;
      settings.specular.gpu.threshold = 0;  // pixels in the dark trace, too
      Pipeline& p = prepare(b.finish("two rooms"), settings);
      const auto brightest = [&](const glm::vec3& from, const glm::vec3& to) {
        float most = 0;
        for (const glm::vec4& value : draw(p, from, to, VIEW_SPECULAR))
          most = std::max({most, value.x, value.y, value.z});
        return most;
      };
      const auto at = [&](float x, float y, float z) { return kTurn * glm::vec3(x, y, z); };
      EXPECT_EQ(brightest(at(14, -3, 3), at(0.5f, -6, 0)), 0) << roughness;
      EXPECT_EQ(brightest(at(1.5f, -5, -5), at(0.6f, -6, 4)), 0) << roughness;
      EXPECT_EQ(brightest(at(1, 5, -5), at(12, -6, 5)), 0) << roughness;
      EXPECT_GT(brightest(at(-2, -3, 3), at(-8, -6, 0)), 0.1f) << roughness;
    }
}

TEST_F(SurfaceTest, AMirrorShowsTheRoomAsItIs) {
  // A room with a mirror for its floor, lit by its ceiling: what the mirror shows of it is B / pi of the point
  // mirrored.
  SceneBuilder b;
  const uint32_t wall = b.material(glm::vec3(0.5f)), lamp = b.material(glm::vec3(0.2f), glm::vec3(5)),
                 mirror = b.material(glm::vec3(1));
  b.edit(mirror).lambertian = false;
  b.edit(mirror).metallic = 1;
  b.edit(mirror).roughness = 0;
  b.box({wall, wall, mirror, lamp, wall, wall}, {-1, -1, -1}, {1, 1, 1}, /*inward=*/true);
  Settings settings = triangles(24, 256);
  settings.specular.mode = SpecularMode::compute;
  settings.specular.gpu.filter_ = false;
  Pipeline& p = prepare(b.finish("mirror"), settings);
  const auto shown = draw(p, {0, 0.3f, 0.6f}, {0, -0.9f, -0.9f}, VIEW_SPECULAR),
             mirrored = draw(p, {0, -2.3f, 0.6f}, {0, -1.1f, -0.9f}, VIEW_LIT);
  // The second camera sees through the floor's back what the first sees in it, upside down.
  size_t compared = 0;
  double sum = 0, truth = 0;
  for (uint32_t y = 0; y < kPixels; ++y)
    for (uint32_t x = 0; x < kPixels; ++x) {
      const float a = shown[y * kPixels + x].x, expected = mirrored[(kPixels - 1 - y) * kPixels + x].x;
      if (a == 0) continue;
      ++compared;
      sum += double{a};
      truth += double{expected};
    }
  EXPECT_GT(compared, 500u);
  EXPECT_NEAR(sum / truth, 1, 0.02);
}

/// Under a pane that reflects nothing, which lets .7 of everything through or a share of each channel. The floor is lit
/// by a sun or, a mirror, shows the ceiling, a lamp.
Scene underAPane(bool mirror, bool glazed, bool tints) {
  SceneBuilder b;
  const uint32_t floor = b.material(glm::vec3(mirror ? 1.0f : 0.5f)),
                 pane = b.material(tints ? glm::vec3(0.9f, 0.5f, 0.2f) : glm::vec3(0), glm::vec3(0), true),
                 lamp = b.material(glm::vec3(0), glm::vec3(5));
  if (tints) {
    b.edit(pane).transmission = 1;
  } else {
    b.edit(pane).alpha = AlphaMode::Blend;
    b.edit(pane).baseColor.a = 0.3f;
  }
  b.quad(floor, {-0.8f, 0, 0.8f}, {0.8f, 0, 0.8f}, {0.8f, 0, -0.8f}, {-0.8f, 0, -0.8f});
  if (glazed) b.quad(pane, {-1, 0.43f, 1}, {1, 0.43f, 1}, {1, 0.45f, -1}, {-1, 0.45f, -1});
  if (mirror) {
    b.edit(floor).lambertian = false;
    b.edit(floor).metallic = 1;
    b.edit(floor).roughness = 0;
    b.quad(lamp, {-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1});
  } else {
    b.sun({0, -1, 0}, 3);
  }
  return b.finish("under a pane");
}

TEST_F(SurfaceTest, PanesLetTheirShareOfTheSunAndOfReflectionsThrough) {
  for (const bool tints : {false, true}) {
    const glm::dvec3 passes = tints ? glm::dvec3(0.9, 0.5, 0.2) : glm::dvec3(0.7);
    glm::dvec3 byFacets[2]{}, byMaps[2]{}, mirrored[2]{};
    for (const bool glazed : {false, true}) {
      Settings settings = triangles(24, 32);
      const auto shown = [&](bool mirror, View view) {
        Pipeline& p = prepare(underAPane(mirror, glazed, tints), settings);
        glm::dvec3 sum(0);
        for (const glm::vec4& value : draw(p, {0, 0.3f, 0.1f}, {0, 0, 0}, view)) sum += glm::dvec3(value);
        return sum;
      };
      byMaps[glazed] = shown(/*mirror=*/false, VIEW_DIRECT_IRRADIANCE);
      const HostFacets f = hostFacets(context(), pipeline_->facets());
      const std::vector<glm::vec3> d = perFacet(context(), pipeline_->facets(), pipeline_->lighting().direct);
      for (size_t i = 0; i < f.count(); ++i)
        if (f.albedo[i].x > 0.4f) byFacets[glazed] += f.area[i] * glm::dvec3(d[i]);
      settings.specular.mode = SpecularMode::compute;
      settings.specular.gpu.filter_ = false;
      mirrored[glazed] = shown(/*mirror=*/true, VIEW_SPECULAR);
    }
    for (int c = 0; c < 3; ++c) {
      EXPECT_GT(mirrored[0][c], 0) << "the mirror shows nothing";
      fmt::print("channel {}: facets {:.4f}, maps {:.4f}, mirror {:.4f} of {}\n", c, byFacets[1][c] / byFacets[0][c],
                 byMaps[1][c] / byMaps[0][c], mirrored[1][c] / mirrored[0][c], passes[c]);
      EXPECT_NEAR(byFacets[1][c] / byFacets[0][c], passes[c], 0.02) << c;
      EXPECT_NEAR(byMaps[1][c] / byMaps[0][c], passes[c], 0.02) << c;
      EXPECT_NEAR(mirrored[1][c] / mirrored[0][c], passes[c], 0.02) << c;
    }
  }
}

TEST_F(SurfaceTest, LightFromBehindTheFaceAddsNothing) {
  // Faces that look up, their vertices' normals towards a sun that shines along them from just below.
  SceneBuilder b;
  const uint32_t floor = b.material(glm::vec3(0.5f));
  b.quad(floor, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}, 4);
  b.sun(glm::normalize(glm::vec3(-1, 0.2f, 0)), 10);
  Scene scene = b.finish("a sun below");
  for (glm::vec3& normal : scene.normals) normal = glm::normalize(glm::vec3(1, 1, 0));
  Pipeline& p = prepare(std::move(scene), triangles(16));
  for (const glm::vec4& value : draw(p, {0, 2, 0.1f}, {0, 0, 0}, VIEW_DIRECT_IRRADIANCE)) EXPECT_EQ(value.x, 0);
  for (const glm::vec3& value : perFacet(context(), p.facets(), p.lighting().direct)) EXPECT_EQ(value.x, 0);
}

TEST_F(SurfaceTest, TheSameListEveryTime) {
  const Scene scene = furnishedRoom();
  expectSame(world(scene, triangles(24)).facets, world(scene, triangles(24)).facets);
}

TEST_F(SurfaceTest, TheSameListInRowsOfWorkgroups) {
  // As on a device whose dimension does not hold all groups of a long list; the last row has some too many.
  const Scene scene = furnishedRoom();
  const World w = world(scene, triangles(24));
  const FacetList& a = w.facets;
  const uint32_t groups = (a.count + LINK_FACETS - 1) / LINK_FACETS;
  uint32_t limit = 5;
  while (foldedWorkgroups(groups, limit).x * foldedWorkgroups(groups, limit).y == groups) ++limit;
  uint32_t& most = const_cast<Device&>(context().device).limits.maxComputeWorkGroupCount[0];
  const uint32_t real = std::exchange(most, limit);
  const FacetList b = listedBy(ListedBy::kernels, w);
  most = real;
  expectSame(a, b);
}

TEST_F(SurfaceTest, TheHostFindsWhatTheKernelsFind) {
  // Voxels of a few pieces; balls of many, some of which are not compared; more sheets in a voxel than it may have
  // facets, no two of them parallel, so that rounding does not choose among facets that face a way alike; a pane.
  const auto crowds = [] {
    SceneBuilder b;
    const uint32_t wall = b.material(glm::vec3(0.5f)),
                   sheet = b.material(glm::vec3(0.7f), glm::vec3(0), /*doubleSided=*/true);
    b.box({wall, wall, wall, wall, wall, wall}, glm::vec3(-1), glm::vec3(1), /*inward=*/true);
    b.sphere(sheet, {0.1f, 0.1f, 0.1f}, 0.03f, /*inward=*/false, 48);
    b.sphere(sheet, {-0.5f, 0.2f, 0.3f}, 0.08f, /*inward=*/false, 16);
    for (int k = 0; k < 40; ++k) {
      const float y = -0.6f + 0.004f * static_cast<float>(k), lean = 0.02f * std::sin(7.1f * static_cast<float>(k));
      b.quad(sheet, {-0.6, y, 0.5}, {0.2, y + lean, 0.5}, {0.2, y, -0.6}, {-0.6, y + lean, -0.6});
    }
    return b.finish("crowds");
  };
  const std::pair<Scene, uint32_t> scenes[] = {
      {furnishedRoom(), 21}, {crowds(), 8}, {underAPane(false, true, /*tints=*/true), 16}};
  for (const auto& [scene, resolution] : scenes) {
    SCOPED_TRACE(scene.path.string());
    const World w = world(scene, triangles(resolution));
    expectSame(listedBy(ListedBy::kernels, w), listedBy(ListedBy::host, w));
  }
}

TEST_F(SurfaceTest, SurfelsLieOnTrianglesOfTheirVoxelThatFaceAsTheFacetDoes) {
  // In the ball's voxel bytes cannot tell the pieces' sides apart, in all others they can.
  SceneBuilder b;
  const uint32_t wall = b.material(glm::vec3(0.5f)),
                 sheet = b.material(glm::vec3(0.7f), glm::vec3(0), /*doubleSided=*/true);
  b.box({wall, wall, wall, wall, wall, wall}, glm::vec3(-1), glm::vec3(1), /*inward=*/true);
  b.sphere(sheet, {0.1f, 0.1f, 0.1f}, 0.08f, /*inward=*/false, 16);
  b.quad(sheet, {-0.6, -0.5, 0.5}, {0.2, -0.5, 0.5}, {0.2, -0.3, -0.6}, {-0.6, -0.3, -0.6});
  const Scene scene = b.finish("crowd");
  const World w = world(scene, triangles(8)), again = world(scene, triangles(8));
  EXPECT_EQ(download(context(), w.facets.surface.wideSides), download(context(), again.facets.surface.wideSides));
  const oracle::Facets f = oracleFacets(context(), w.facets);
  size_t wide = 0;
  for (uint32_t i = 0; i < w.facets.count; ++i) {
    const glm::uvec3 voxel = unpackVoxel(f.voxel[i]);
    const uint32_t entry = f.reverse[voxelIndex(voxel, f.grid.dims)], first = firstFacet(entry);
    const auto pieces =
        std::span(f.pieces).subspan(f.firstPiece[first], f.firstPiece[first + facetsOf(entry)] - f.firstPiece[first]);
    wide += pieces.size() > MOST_NARROW;
    for (uint32_t k = FACET_SURFELS * i; k < FACET_SURFELS * (i + 1); ++k) {
      const uint32_t triangle = f.surfels[k].triangle & ~SURFEL_BACK;
      EXPECT_TRUE(std::ranges::any_of(pieces, [&](uint32_t p) { return (p & ~PIECE_SMALL) == triangle; }));
      const glm::dvec3 p = f.point(k), c[3] = {f.corner(triangle, 0), f.corner(triangle, 1), f.corner(triangle, 2)};
      const glm::dvec3 normal = glm::normalize(glm::cross(c[1] - c[0], c[2] - c[0]));
      EXPECT_GT(glm::dot(normal, f.normal(i)) * ((f.surfels[k].triangle & SURFEL_BACK) != 0 ? -1 : 1), 0);
      for (int e = 0; e < 3; ++e) {
        const glm::dvec3 inward = glm::normalize(glm::cross(normal, c[(e + 1) % 3] - c[e]));
        EXPECT_GT(glm::dot(inward, p - c[e]), -1e-4) << "facet " << i << ", surfel " << k;
        EXPECT_NEAR(p[e], voxel[e] + 0.5, 0.5 + 1e-4);
      }
    }
  }
  EXPECT_GT(wide, 8u);
  EXPECT_LT(wide, w.facets.count / 2);
}

TEST_F(SurfaceTest, WhatItCannotDoIsAnError) {
  Settings settings = triangles(8);
  settings.matrix.format = MatrixFormat::padded;
  EXPECT_THROW(world(furnaceBox(0.5f), settings), UsageError);
  settings = triangles(8);
  settings.voxel.method = VoxelMethod::raster;
  EXPECT_THROW(world(furnaceBox(0.5f), settings), UsageError);
  // A ball far smaller than a voxel: as many triangles in one as it takes, or more than there may be.
  for (const uint32_t rings : {48u, 160u}) {
    SceneBuilder b;
    const uint32_t wall = b.material(glm::vec3(0.5f));
    b.box({wall, wall, wall, wall, wall, wall}, glm::vec3(-1), glm::vec3(1), /*inward=*/true, glm::mat3(1));
    b.sphere(wall, {0.1f, 0.1f, 0.1f}, 0.01f, /*inward=*/false, rings);
    const Scene scene = b.finish("ball");
    if (rings == 48)
      EXPECT_GT(world(scene, triangles(8)).facets.count, 8u * 8u * 6u);
    else
      EXPECT_THROW(world(scene, triangles(8)), WorkError);
  }
}

TEST_F(SurfaceTest, NoPixelAtTheFootOfAWallIsDark) {
  // A room whose walls stand on a floor and under a ceiling that go on beneath them. Pictures round corners to
  // fractions of a pixel, so that along a seam some pixels show a floor that is behind the wall's face, by less than a
  // thousandth of a voxel, where no light is.
  SceneBuilder b;
  const uint32_t grey = b.material(glm::vec3(0.5f)), lamp = b.material(glm::vec3(0.5f), glm::vec3(5));
  const auto slab = [&](uint32_t m, const glm::vec3& lo, const glm::vec3& hi) {
    b.box({m, m, m, m, m, m}, lo, hi, /*inward=*/false);
  };
  slab(grey, {-2.2f, -0.2f, -2.7f}, {2.2f, 0, 2.7f});
  slab(lamp, {-2.2f, 2.43f, -2.7f}, {2.2f, 2.63f, 2.7f});
  slab(grey, {-2.2f, 0, -2.5f}, {-2, 2.43f, 2.5f});
  slab(grey, {2, 0, -2.5f}, {2.2f, 2.43f, 2.5f});
  slab(grey, {-2.2f, 0, -2.7f}, {2.2f, 2.43f, -2.5f});
  slab(grey, {-2.2f, 0, 2.5f}, {2.2f, 2.43f, 2.7f});
  Pipeline& p = prepare(b.finish("room"), triangles(24, 64));
  size_t dark = 0;
  for (int k = 0; k < 64; ++k) {
    const float turn = 0.37f * static_cast<float>(k), high = 0.5f + 0.021f * static_cast<float>(k);
    const glm::vec3 way(std::sin(turn), k % 2 == 0 ? -0.4f : 0.5f, std::cos(turn));
    const glm::vec3 from = glm::vec3(0, high, 0) - glm::vec3(1.2f, 0, 1.2f) * way;
    for (const glm::vec4& h : draw(p, from, from + way, VIEW_INDIRECT)) dark += h.x < 0.05f;
  }
  EXPECT_EQ(dark, 0u);
}

TEST_F(SurfaceTest, NoLightGetsIntoSealedBuildings) {
  // Each was lit once: walls that cross at a shallow angle, edges of columns that stick out of the voxel, a wall on a
  // voxel's border, more facets in a voxel than there may be.
  struct Case {
    uint64_t seed;
    uint32_t resolution;
  };
  for (const Case c : {Case{22, 32}, Case{1, 32}, Case{21, 32}, Case{27, 48}}) {
    const auto family = std::ranges::find_if(families(), &Family::dark);
    const FamilyMember member = familyMember(*family, c.seed, c.resolution);
    const Pipeline& p = prepare(member.scene, triangles(c.resolution, 64));
    draw(*pipeline_, glm::vec3(0), glm::vec3(0, 0, -1), VIEW_LIT);
    const HostFacets f = hostFacets(context(), p.facets());
    const std::vector<glm::vec3> d = perFacet(context(), p.facets(), p.lighting().direct),
                                 h = perFacet(context(), p.facets(), p.lighting().indirect);
    const auto isInside = [&](const glm::dvec3& point) {
      return std::ranges::any_of(member.sealed, [&](const Room& room) { return room.contains(point); });
    };
    size_t inside = 0;
    double outside = 0, most = 0;
    for (size_t i = 0; i < f.count(); ++i) {
      outside = std::max(outside, double{d[i].x});
      const auto surfels = std::span(f.surfels).subspan(FACET_SURFELS * i, FACET_SURFELS);
      if (!std::ranges::all_of(surfels,
                               [&](const glm::dvec3& s) { return isInside(s + 1e-3 * f.grid.edge * f.normal[i]); }))
        continue;
      ++inside;
      most = std::max(most, double{d[i].x + h[i].x});
    }
    EXPECT_GT(inside, 1000u);
    EXPECT_GT(outside, 1);
    EXPECT_EQ(most, 0) << "seed " << c.seed << " at " << c.resolution;
  }
}

}  // namespace
}  // namespace irad::test::surface_suite
