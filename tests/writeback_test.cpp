// Reflections written back (docs/method.md 8): the thesis's mask against T eq. 25-28 in double precision, the mean over
// a facet's pixels against the G-buffer read back, a closed form, the bound on the loop, and what it costs while off.
#include "gi/writeback.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "gi/check/writeback_figures.h"
#include "shaders/shared/ggx.h"
#include "tests/effects_fixture.h"
#include "tests/test_shaders.h"

namespace irad::test::writeback_suite {
namespace {

constexpr double kPi = std::numbers::pi;

class Reflections : public EffectsTest {
 protected:
  static constexpr glm::uvec2 kPicture{64, 48};
  static Settings writing(WritebackMode mode, Settings s = small()) {
    s.writeback.mode = mode;
    return s;
  }
  std::unique_ptr<Pipeline> prepared(Scene scene, const Settings& settings) {
    auto pipeline = std::make_unique<Pipeline>(context(), std::move(scene), settings);
    pipeline->prepare();
    return pipeline;
  }
  void picture(Pipeline& pipeline, Targets& targets, View view = VIEW_LIT) {
    Frame frame = context().begin();
    pipeline.render(frame, pipeline.scene().cameras.at(0), view, targets);
    frame.submitAndWait();
  }
  WritebackRounds settle(Pipeline& pipeline) {
    Targets targets(context(), kPicture);
    return pipeline.settleReflections(pipeline.scene().cameras.at(0), targets);
  }
  Pixels perFacet(const Pipeline& pipeline, const Buffer& buffer) {
    Pixels values = downloadAs<glm::vec4>(context(), buffer);
    values.resize(pipeline.facets().count);
    return values;
  }
  Pixels image(const Image& image) {
    const std::vector<std::byte> bytes = download(context(), image);
    Pixels out(bytes.size() / sizeof(glm::vec4));
    std::memcpy(out.data(), bytes.data(), bytes.size());
    return out;
  }
  static float largest(const Pixels& values) {
    float most = 0;
    for (const glm::vec4& v : values) most = std::max({most, v.x, v.y, v.z});
    return most;
  }
  double meanH(const Pipeline& p) {
    const Pixels h = perFacet(p, p.lighting().indirect);
    const std::vector<float> area = downloadAs<float>(context(), p.facets().area);
    double sum = 0, all = 0;
    for (size_t i = 0; i < h.size(); ++i) sum += double{area[i]} * h[i].x, all += area[i];
    return sum / all;
  }
  /// A still life of materials with occlusion that leaves the loop alone: rho + s < .95 everywhere but at grazing
  /// angles.
  static Scene glossyRoom() {
    Scene scene = stillLife().finish("glossy room");
    for (Material& m : scene.materials) m.baseColor *= glm::vec4(glm::vec3(0.6f), 1), m.roughness = 0.25f;
    return scene;
  }
};

/// T eq. 25-28 from the text, in double precision.
double thesisScore(double distance, const glm::dvec3& v, const glm::dvec3& n, const WritebackParams& params) {
  const double d = std::pow(distance, double{params.alpha});
  double squares = 0;
  for (int i = 0; i < 3; ++i) {
    const double g = v[i] - std::floor(v[i]);
    const double blended = g * (1 - std::abs(n[i])) + 0.5 * std::abs(n[i]);
    squares += (blended - 0.5) * (blended - 0.5);
  }
  return std::clamp(1 - double{params.k} * std::sqrt(squares) / d, 0.0, 1.0);
}

TEST_F(Reflections, MaskIsTheThesiss) {
  constexpr uint32_t count = 100000;
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0, 1);
  Pixels at(count), normals(count);
  for (uint32_t i = 0; i < count; ++i) {
    at[i] = glm::vec4(unit(random) * 64, unit(random) * 64, unit(random) * 64, std::exp(8 * unit(random) - 4));
    glm::vec3 n(unit(random) - 0.5f, unit(random) - 0.5f, unit(random) - 0.5f);
    if (i % 5 == 0) n = glm::vec3(i % 3 == 0, i % 3 == 1, i % 3 == 2);  // along the voxels
    normals[i] = glm::vec4(glm::normalize(n), 0);
  }
  const Buffer atBuffer = makeBuffer<glm::vec4>(context(), "at", Subsystem::Staging, at),
               normalBuffer = makeBuffer<glm::vec4>(context(), "normals", Subsystem::Staging, normals),
               scores(context().device, "scores", Subsystem::Staging, 4ull * count);
  struct Push {
    uint64_t at, normal, score;
    WritebackParams params;
    uint32_t count;
  };
  for (const WritebackParams params : {Settings{}.writeback.gpu, WritebackParams{0.25f, 0.7f, 0.6f}}) {
    Frame frame = context().begin();
    Pass pass = frame.pass("Mask");
    const Push push{pass.in(atBuffer), pass.in(normalBuffer), pass.out(scores), params, count};
    pass.shader(shader("writeback_mask.comp")).push(push).dispatch(count);
    frame.submitAndWait();
    const std::vector<float> device = downloadAs<float>(context(), scores);
    uint32_t selected = 0, doubtful = 0;
    for (uint32_t i = 0; i < count; ++i) {
      const double expected = thesisScore(at[i].w, glm::vec3(at[i]), glm::vec3(normals[i]), params);
      // Positions of up to 64 voxels hold 4e-6 voxel, times k / d.
      const double exact = 1e-5 * (1 + params.k / std::pow(double{at[i].w}, double{params.alpha}));
      ASSERT_NEAR(device[i], expected, exact) << i;
      const bool selects = expected >= params.threshold;
      selected += selects;
      if (std::abs(expected - params.threshold) <= exact)
        ++doubtful;
      else
        ASSERT_EQ(device[i] >= params.threshold, selects) << i;
    }
    EXPECT_GT(selected, count / 100);
    EXPECT_LT(selected, count - count / 100);
    EXPECT_LT(doubtful, count / 1000);
  }
}

TEST_F(Reflections, ComputeWritesTheMeanOfAFacetsPixels) {
  const auto pipeline = prepared(glossyRoom(), writing(WritebackMode::compute));
  Targets targets(context(), kPicture);
  picture(*pipeline, targets);
  const uint32_t facets = pipeline->facets().count;
  const Pixels specular = image(targets.specular), drawn = perFacet(*pipeline, pipeline->lighting().writeback.drawn);
  const std::vector<uint32_t> facetOf = downloadAs<uint32_t>(context(), targets.facet),
                              pixels = downloadAs<uint32_t>(context(), pipeline->lighting().writeback.pixels);
  std::vector<glm::dvec3> sum(facets);
  std::vector<uint32_t> count(facets);
  for (size_t i = 0; i < facetOf.size(); ++i) {
    if (facetOf[i] == NO_FACET) continue;
    sum.at(facetOf[i]) += kPi * glm::dvec3(specular[i]);
    ++count[facetOf[i]];
  }
  const double most = largest(drawn);
  ASSERT_GT(most, 0);
  uint32_t seen = 0, below = 0;
  for (uint32_t f = 0; f < facets; ++f) {
    EXPECT_EQ(pixels[f], count[f]) << f;
    EXPECT_EQ(drawn[f].w, count[f] > 0 ? 1 : 0) << f;
    seen += count[f] > 0;
    for (int c = 0; c < 3; ++c) {
      const double mean = count[f] > 0 ? sum[f][c] / count[f] : 0;
      EXPECT_LE(drawn[f][c], mean + 1e-6 * most) << f;
      below += drawn[f][c] < mean * (1 - 1e-5) - 1e-7 * most;
    }
  }
  const WritebackReport& report = *pipeline->lighting().writeback.report;
  EXPECT_FALSE(report.pending);
  EXPECT_EQ(report.visible(), seen);
  EXPECT_EQ(report.written(), seen);
  EXPECT_EQ(report.writers[1], seen);
  EXPECT_EQ(report.largest, most);
  EXPECT_EQ(report.change, most) << "light was solved without";
  // Less than the mean only where some pixel looks along the surface, and would reflect nearly all.
  EXPECT_LT(below, 3 * seen / 20);
  EXPECT_GT(seen, 100u);
}

TEST_F(Reflections, SameBitsInEveryRun) {
  Pixels first, light;
  for (int i = 0; i < 2; ++i) {
    const auto pipeline = prepared(glossyRoom(), writing(WritebackMode::compute));
    const WritebackRounds rounds = settle(*pipeline);
    EXPECT_TRUE(rounds.settled);
    const Pixels drawn = perFacet(*pipeline, pipeline->lighting().writeback.drawn),
                 b = perFacet(*pipeline, pipeline->lighting().radiosity);
    if (i == 0) first = drawn, light = b;
    EXPECT_TRUE(same(first, drawn) && same(light, b));
    // At rest nothing is due, and the same picture writes the same back.
    EXPECT_TRUE(pipeline->asleep());
    const uint64_t before = context().counters().dispatches;
    pipeline->prepare();
    EXPECT_EQ(context().counters().dispatches, before);
    Targets targets(context(), kPicture);
    for (int again = 0; again < 3; ++again) {
      picture(*pipeline, targets);
      EXPECT_TRUE(same(drawn, perFacet(*pipeline, pipeline->lighting().writeback.drawn)));
      EXPECT_TRUE(pipeline->asleep());
    }
  }
}

/// What a pixel with a facet may write, by the formulas of docs/method.md 8: recomputed for facets with one writer.
TEST_F(Reflections, MaskStoresWhatItsFragmentsShow) {
  for (const Rasterizer rasterizer : {Rasterizer::hardware, Rasterizer::kernels})
    for (const HitRule rule : {HitRule::triangles, HitRule::thesis}) {
      SCOPED_TRACE(fmt::format("{} {}", nameOf(rasterizer), nameOf(rule)));
      Settings s = writing(WritebackMode::mask);
      s.rasterizer = rasterizer;
      s.matrix.gpu.hitRule = rule;
      s.specular.mode = rule == HitRule::thesis ? SpecularMode::fragment : SpecularMode::compute;
      s.writeback.gpu.threshold = 0.8f;
      const auto pipeline = prepared(glossyRoom(), s);
      Targets targets(context(), kPicture);
      picture(*pipeline, targets);
      const Writeback& w = pipeline->lighting().writeback;
      const Pixels drawn = perFacet(*pipeline, w.drawn);
      const std::vector<uint32_t> pixels = downloadAs<uint32_t>(context(), w.pixels),
                                  writers = downloadAs<uint32_t>(context(), w.writers);
      EXPECT_EQ(static_cast<bool>(targets.facet), rule == HitRule::triangles);
      uint32_t stores = 0, one = 0, none = 0;
      for (uint32_t f = 0; f < pipeline->facets().count; ++f) {
        ASSERT_LE(writers[f], pixels[f]) << f;
        EXPECT_EQ(drawn[f].w, static_cast<float>(writers[f])) << f;
        stores += writers[f];
        one += writers[f] == 1;
        none += pixels[f] > 0 && writers[f] == 0;
        EXPECT_TRUE(writers[f] > 0 || glm::vec3(drawn[f]) == glm::vec3(0)) << f;
      }
      EXPECT_EQ(w.report->stores, stores);
      EXPECT_EQ(w.report->writers[0], none);
      EXPECT_EQ(w.report->writers[1], one);
      EXPECT_GT(one, 10u);
      EXPECT_GT(none, 10u);
      EXPECT_GT(w.report->largest, 0);
      if (rule == HitRule::thesis) continue;
      // Whatever was stored is what a pixel of the facet shows, or less where it would reflect too much.
      const Pixels specular = image(targets.specular);
      const std::vector<uint32_t> facetOf = downloadAs<uint32_t>(context(), targets.facet);
      std::vector<glm::vec3> most(pipeline->facets().count, glm::vec3(0)), least(most.size(), glm::vec3(1e30f));
      for (size_t i = 0; i < facetOf.size(); ++i) {
        if (facetOf[i] == NO_FACET) continue;
        const glm::vec3 value = static_cast<float>(kPi) * glm::vec3(specular[i]);
        most[facetOf[i]] = glm::max(most[facetOf[i]], value);
        least[facetOf[i]] = glm::min(least[facetOf[i]], value);
      }
      uint32_t below = 0, checked = 0;
      for (uint32_t f = 0; f < most.size(); ++f) {
        if (writers[f] == 0) continue;
        ++checked;
        for (int c = 0; c < 3; ++c) {
          EXPECT_LE(drawn[f][c], most[f][c] * (1 + 1e-5f) + 1e-9f) << f;
          below += drawn[f][c] < least[f][c] * (1 - 1e-5f);
        }
      }
      EXPECT_LT(below, 3 * checked / 10);
    }
}

/// A mirror, a lamp that fills what it shows to an orthographic camera, and a floor between them: W is F0 x M, and what
/// the floor gains W x the form factor of two perpendicular squares.
TEST_F(Reflections, LightTheFloorBesideAMirrorAsTheClosedFormSays) {
  SceneBuilder b;
  const uint32_t mirror = b.material(glm::vec3(0.8f)), lamp = b.material(glm::vec3(0), glm::vec3(1)),
                 floor = b.material(glm::vec3(0.5f));
  b.edit(mirror).metallic = 1;
  b.edit(mirror).roughness = 0;
  b.edit(floor).lambertian = b.edit(lamp).lambertian = true;
  b.quad(mirror, {0, 0, 1}, {0, 0, 0}, {0, 1, 0}, {0, 1, 1});
  b.quad(lamp, {1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0});
  b.quad(floor, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}, {0, 0, 0});
  b.camera({0.9, 0.5, 0.5}, {0, 0.5, 0.5});
  Scene scene = b.finish("mirror");
  scene.cameras[0].orthographic = true;
  scene.cameras[0].ymag = 0.55f;
  scene.cameras[0].znear = 0.01f;

  Settings s = at(16, 512);
  s.solver.tolerance = 1e-5f;
  const auto floorH = [&](WritebackMode mode, double* written) {
    const auto pipeline = prepared(scene, writing(mode, s));
    const WritebackRounds rounds = settle(*pipeline);
    EXPECT_EQ(rounds.settled, mode != WritebackMode::off);
    const Pixels h = perFacet(*pipeline, pipeline->lighting().indirect);
    const Pixels w =
        mode == WritebackMode::off ? Pixels(h.size()) : perFacet(*pipeline, pipeline->lighting().writeback.used);
    const std::vector<float> area = downloadAs<float>(context(), pipeline->facets().area);
    const std::vector<glm::uvec2> albedo = downloadAs<glm::uvec2>(context(), pipeline->facets().albedo);
    const std::vector<uint32_t> voxel = downloadAs<uint32_t>(context(), pipeline->facets().voxel);
    double sum = 0, all = 0, source = 0, mirrorArea = 0;
    for (size_t i = 0; i < h.size(); ++i) {
      const bool isFloor = unpackAlbedo(albedo[i]).x > 0.4f, isMirror = !isFloor && unpackVoxel(voxel[i]).x <= 1;
      if (isFloor) sum += double{area[i]} * h[i].x, all += area[i];
      if (isMirror) source += double{area[i]} * w[i].x, mirrorArea += area[i];
      EXPECT_TRUE(isMirror || w[i].x == 0) << i;
    }
    if (written != nullptr) *written = source / mirrorArea;
    return sum / all;
  };
  const double without = floorH(WritebackMode::off, nullptr), factor = formFactorPerpendicularSquares();
  EXPECT_NEAR(without, factor, 0.02 * factor) << "straight from the lamp";
  double written = 0;
  const double gain = floorH(WritebackMode::compute, &written) - without;
  EXPECT_NEAR(written, 0.8, 0.01);
  EXPECT_NEAR(gain, 0.8 * factor, 0.02 * factor);
}

/// Whatever the scene: rho + s <= .95, so that no B is above 20 E.
TEST_F(Reflections, NeverLightMoreThanTwentyTimesTheSource) {
  struct Room {
    const char* name;
    float albedo, metallic, roughness;
  };
  for (const Room& room :
       {Room{"mirrors", 1, 1, 0}, Room{"rough metal", 1, 1, 0.5f}, Room{"white varnish", 0.93f, 0, 0}})
    for (const WritebackMode mode : {WritebackMode::mask, WritebackMode::compute}) {
      SCOPED_TRACE(fmt::format("{} {}", room.name, nameOf(mode)));
      SceneBuilder b;
      const uint32_t wall = b.material(glm::vec3(room.albedo)), lamp = b.material(glm::vec3(0), glm::vec3(1));
      b.edit(wall).metallic = room.metallic;
      b.edit(wall).roughness = room.roughness;
      b.box({wall, wall, wall, lamp, wall, wall}, glm::vec3(-0.5f), glm::vec3(0.5f), /*inward=*/true);
      b.camera({0, 0, 0.45}, {0, 0, -1});
      Settings s = at(8, 64);
      s.writeback.gpu.threshold = 0.5f;  // of these few voxels nearly all are written
      const auto pipeline = prepared(b.finish(room.name), writing(mode, s));
      EXPECT_GT(perFacet(*pipeline, pipeline->lighting().writeback.used).size(), 0u);
      const WritebackRounds rounds = settle(*pipeline);
      EXPECT_TRUE(rounds.settled || mode == WritebackMode::mask);
      const Pixels radiosity = perFacet(*pipeline, pipeline->lighting().radiosity),
                   written = perFacet(*pipeline, pipeline->lighting().writeback.used);
      const std::vector<glm::uvec2> albedo = downloadAs<glm::uvec2>(context(), pipeline->facets().albedo);
      const float most = largest(radiosity);
      EXPECT_LE(most, 20);
      EXPECT_GT(most, 1) << "the lamp itself";
      for (size_t i = 0; i < written.size(); ++i) {
        const glm::vec3 room_ = glm::max(WRITEBACK_GAIN - unpackAlbedo(albedo[i]), glm::vec3(0));
        for (int c = 0; c < 3; ++c) EXPECT_LE(written[i][c], room_[c] * most * 1.01f) << i;
      }
      EXPECT_GT(largest(written), 0);
    }
}

TEST_F(Reflections, OffCostNothingAndLeaveNothing) {
  const auto pipeline = prepared(glossyRoom(), small());
  const auto state = [&] {
    pipeline->darken();
    pipeline->prepare();
    Pixels out = draw(*pipeline);
    std::ranges::copy(perFacet(*pipeline, pipeline->lighting().indirect), std::back_inserter(out));
    return out;
  };
  const auto edit = [&](const char* assignment) {
    setting(assignment)(*pipeline);
    pipeline->prepare();
  };
  timings().reset();  // of earlier tests
  const Pixels before = state();
  expect(facts(*pipeline), "-GI Writeback, -has writeback, -has facets of pixels, writeback off");
  const uint64_t bytes = app::heldBytes(context());
  for (const char* mode : {"mask", "compute"}) {
    edit(fmt::format("writeback.mode={}", mode).c_str());
    draw(*pipeline);
    expect(facts(*pipeline), "GI Writeback, has writeback, has facets of pixels, writeback on");
    EXPECT_FALSE(pipeline->asleep()) << "the picture has written something back";
    EXPECT_TRUE(pipeline->plan().on(Effect::relight));
    const double dark = meanH(*pipeline);
    pipeline->prepare();
    EXPECT_GT(meanH(*pipeline), dark * (1 + 1e-3)) << mode;
    edit("writeback.mode=off");
    EXPECT_TRUE(same(state(), before)) << mode;
    expect(facts(*pipeline), "-GI Writeback, -has writeback, -has facets of pixels, writeback off");
    EXPECT_EQ(app::heldBytes(context()), bytes);
  }
  // Without light, or without a lobe, nothing is written back whatever the mode.
  edit("writeback.mode=compute");
  draw(*pipeline);
  (void)facts(*pipeline);
  edit("specular.mode=off");
  draw(*pipeline);
  expect(facts(*pipeline), "-GI Writeback, -has writeback, -has facets of pixels, writeback off");
}

TEST_F(Reflections, PlanProvesWhatItLeavesOut) {
  // No material reflects: forced on, reflections of nothing are written back, and the bits are the same.
  const Scene matt = room(true);
  const auto planned = bench(matt, writing(WritebackMode::compute)),
             forced = bench(matt, app::allForcedOn(writing(WritebackMode::compute)));
  EXPECT_TRUE(planned->pipeline().plan().off(Effect::writeback));
  EXPECT_TRUE(forced->pipeline().plan().on(Effect::writeback));
  constexpr View views[]{VIEW_LIT};
  EXPECT_EQ(app::proveAll("matt", *planned, *forced, views).difference->pixels, 0u);
  app::require(app::proveEach("matt", *planned, views));
  // Where they are written back the other rows are proven as ever.
  const auto glossy = bench(glossyRoom(), writing(WritebackMode::compute));
  EXPECT_TRUE(glossy->pipeline().plan().on(Effect::writeback));
  app::require(app::proveEach("glossy", *glossy, views));
}

TEST_F(Reflections, ViewsShowMaskWritersAndW) {
  const auto pipeline = prepared(glossyRoom(), writing(WritebackMode::mask));
  Targets targets(context(), {256, 192});  // several pixels between two seams
  picture(*pipeline, targets, VIEW_WRITEBACK_MASK);
  const Pixels mask = image(targets.linear);
  const auto red = std::ranges::count_if(mask, [](const glm::vec4& p) { return glm::vec3(p) == glm::vec3(1, 0, 0); });
  // Of pixels without a facet the mask selects none in this closed room.
  EXPECT_EQ(static_cast<uint32_t>(red), pipeline->lighting().writeback.report->stores);
  EXPECT_GT(red, 0);
  EXPECT_GT(std::ranges::count_if(mask, [](const glm::vec4& p) { return glm::vec3(p) == glm::vec3(1); }), 0);
  picture(*pipeline, targets, VIEW_WRITEBACK_WRITERS);
  float writers = 0;
  for (const glm::vec4& p : image(targets.linear)) writers = std::max(writers, p.x);
  EXPECT_GE(writers, 1);
  picture(*pipeline, targets, VIEW_WRITEBACK);
  EXPECT_GT(largest(image(targets.linear)), 0);
}

}  // namespace
}  // namespace irad::test::writeback_suite
