// The window's inspector without a window: picks by pixel, links followed and left, and what becomes of a pick after a
// relight, a rebuild and another scene.
#include "tests/gi_fixture.h"

#if IRAD_UI

#define GLM_ENABLE_EXPERIMENTAL
#include <glm/gtx/quaternion.hpp>

#include <cstring>

#include "gi/lighting.h"
#include "renderer/base/error.h"
#include "shaders/shared/emitters.h"
#include "ui/session.h"

namespace irad::test::inspection_suite {
namespace {

class InspectionTest : public GiTest {
 protected:
  void SetUp() override {
    GiTest::SetUp();
    session_ = std::make_unique<Session>(context());
    session_->targets = Targets(context(), {64, 48});
    load(furnaceBox(0.5f));
  }
  void load(Scene scene) {
    scene.path = scene.sha256 = fmt::format("scene {}", ++scenes_);
    session_->pipeline = std::make_unique<Pipeline>(context(), std::move(scene), at(16, 32));
    build();
  }
  void build() {
    session_->pipeline->prepare();
    session_->built = Built{.solve = session_->pipeline->lighting().report};
  }
  /// The picture from the middle of the room.
  void draw(const glm::dvec3& direction, View view) {
    session_->shown = Camera{};
    session_->shown.orientation = glm::quat(glm::rotation(glm::vec3(0, 0, -1), glm::vec3(direction)));
    session_->shown.position = session_->pipeline->scene().origin;
    session_->shown.znear = 0.01f;
    session_->view = view;
    Frame frame = context().begin();
    session_->pipeline->render(frame, session_->shown, view, session_->targets);
    frame.submitAndWait();
  }
  bool pick(const glm::uvec2& pixel, bool compare = false) {
    inspection().pick = Inspection::Pick{pixel, compare};
    return inspection().serve(*session_);
  }
  Inspection& inspection() { return session_->inspection; }

  std::unique_ptr<Session> session_;
  int scenes_ = 0;
};

TEST_F(InspectionTest, PicksTheFacetInThePixel) {
  const glm::dvec3 walls[] = {{1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}};
  for (const View view : {View{VIEW_LIT}, View{VIEW_VOXEL_ALBEDO}})
    for (const glm::dvec3& wall : walls) {
      draw(wall, view);
      ASSERT_TRUE(pick({32, 24}));
      ASSERT_TRUE(inspection().facet());
      // The wall ahead, in its middle, seen from its front.
      EXPECT_LT(glm::distance(inspection().facet()->normal, -wall), 1e-6);
      const glm::ivec3 away = glm::abs(glm::ivec3(inspection().voxel->voxel) * 2 - glm::ivec3(17));
      EXPECT_EQ(away.x + away.y + away.z, 15 + 1 + 1) << "view " << view;
    }
  // Nothing changes until something is asked; letting go leaves nothing.
  EXPECT_FALSE(inspection().serve(*session_));
  inspection().clear = true;
  EXPECT_TRUE(inspection().serve(*session_));
  EXPECT_FALSE(inspection().facet());
}

TEST_F(InspectionTest, PicksTheCellThatASliceShows) {
  Settings& settings = session_->edited = at(16, 32);
  settings.view.shape = ViewShape::slice;
  settings.view.jfaPass = 0;  // the seeds alone: what is solid shows its own coordinates
  size_t solid = 0, empty = 0;
  for (const auto& [axis, share] :
       {std::pair{Axis::x, 0.2f}, {Axis::y, 0.4f}, {Axis::z, 0.9f}, {Axis::automatic, 0.7f}}) {
    settings.view.axis = axis;
    settings.view.slice = share;
    session_->pipeline->set(settings);
    build();
    for (const glm::dvec3& towards : {glm::dvec3(-1, 0.4, -0.6), glm::dvec3(0.5, -0.7, 1)}) {
      const auto values = [&](View view) {
        draw(glm::normalize(towards), view);
        const std::vector<std::byte> bytes = download(context(), session_->targets.linear);
        const auto* first = reinterpret_cast<const glm::vec4*>(bytes.data());
        return std::vector<glm::vec4>(first, first + bytes.size() / sizeof(glm::vec4));
      };
      const std::vector<glm::vec4> distances = values(VIEW_DISTANCE_CHEBYSHEV), seeds = values(VIEW_JFA_SEEDS);
      for (uint32_t y = 0; y < 48; y += 7)
        for (uint32_t x = 0; x < 64; x += 9) {
          const glm::vec4 distance = distances[y * 64 + x], seed = seeds[y * 64 + x];
          pick({x, y});
          ASSERT_EQ(inspection().voxel.has_value(), distance.w > 0);
          if (distance.w == 0) continue;
          EXPECT_EQ(inspection().voxel->distance, distance.x);
          ASSERT_EQ(inspection().facet() != nullptr, seed.w > 0);
          ++(seed.w > 0 ? solid : empty);
          if (seed.w == 0) continue;
          EXPECT_EQ(glm::vec3(inspection().voxel->voxel), glm::vec3(seed));
          EXPECT_EQ(session_->edited.view.facet, inspection().facet()->facet) << "matrix-row shows another one";
        }
    }
  }
  EXPECT_GT(solid, 20u);
  EXPECT_GT(empty, 20u);
}

TEST_F(InspectionTest, WhatIsUnderTheMouseIsWhatAClickPicks) {
  Settings& settings = session_->edited = at(16, 32);
  settings.view.shape = ViewShape::automatic;
  session_->pipeline->set(settings);
  build();
  Pointing& pointing = session_->pointing;
  const auto reading = [&](const glm::uvec2& pixel) {
    pointing.over = Pointing::Over{pixel};
    const Counters before = context().counters();
    Frame frame = context().beginUntimed();
    pointing.record(*session_, frame);
    frame.submitAndWait();
    EXPECT_EQ(context().counters().since(before).dispatches, 0u);
    return pointing.take(*session_);
  };
  size_t facets = 0;
  for (const View view : {View{VIEW_LIT}, View{VIEW_DEPTH}, View{VIEW_VOXEL_ALBEDO}, View{VIEW_JFA_SEEDS}}) {
    draw(glm::normalize(glm::dvec3(-1, 0.4, -0.6)), view);
    ++session_->pictures;
    const std::vector<std::byte> bytes = download(context(), session_->targets.linear);
    for (const glm::uvec2 pixel : {glm::uvec2(0, 0), glm::uvec2(20, 31), glm::uvec2(63, 47)}) {
      ASSERT_TRUE(reading(pixel)) << "nothing has come back";
      ASSERT_TRUE(pointing.reading);
      glm::vec4 value;
      std::memcpy(&value, bytes.data() + sizeof(value) * (pixel.y * 64 + pixel.x), sizeof(value));
      EXPECT_EQ(pointing.reading->pixel, pixel);
      const std::string wanted = value.w == 0 ? std::string("nothing")
                                 : view == VIEW_DEPTH
                                     ? fmt::format("{:.4g} m", value.x)
                                     : fmt::format("{:.4g}  {:.4g}  {:.4g}", value.x, value.y, value.z);
      EXPECT_TRUE(pointing.reading->value.starts_with(wanted)) << pointing.reading->value << " is not " << wanted;
      pick(pixel);
      EXPECT_EQ(pointing.reading->voxel.has_value(), inspection().voxel.has_value());
      if (inspection().voxel && pointing.reading->voxel) {
        EXPECT_EQ(*pointing.reading->voxel, inspection().voxel->voxel);
      }
      ASSERT_EQ(pointing.reading->facet.has_value(), inspection().facet() != nullptr);
      if (!inspection().facet()) continue;
      ++facets;
      EXPECT_EQ(*pointing.reading->facet, inspection().facet()->facet) << "view " << view;
      EXPECT_FALSE(pointing.reading->material.empty());
    }
  }
  EXPECT_GE(facets, 9u);
  // Asked once for a pixel of a picture.
  EXPECT_FALSE(reading({63, 47}));
  ++session_->pictures;
  EXPECT_TRUE(reading({63, 47}));
  pointing.over.reset();
  Frame frame = context().beginUntimed();
  pointing.record(*session_, frame);
  frame.submitAndWait();
  EXPECT_FALSE(pointing.take(*session_)) << "the mouse is elsewhere";

  // Many pixels at once, for numbers in them.
  pointing.large = {{3, 5}, {4, 2}};
  draw({0, 0, -1}, VIEW_LIT);
  Frame values = context().beginUntimed();
  pointing.record(*session_, values);
  values.submitAndWait();
  const std::vector<std::byte> bytes = download(context(), session_->targets.linear);
  ASSERT_EQ(pointing.values.size(), 8u);
  for (uint32_t i = 0; i < 8; ++i)
    EXPECT_EQ(std::memcmp(&pointing.values[i], bytes.data() + 16 * ((5 + i / 4) * 64 + 3 + i % 4), 16), 0) << i;
}

TEST_F(InspectionTest, TheHistogramIsCountedWhileItIsShownAndThePictureIsAnother) {
  session_->edited = at(16, 32);
  ShownHistogram& histogram = session_->histogram;
  const auto record = [&] {
    const uint64_t before = context().counters().dispatches;
    Frame frame = context().beginUntimed();
    histogram.record(*session_, frame);
    frame.submitAndWait();
    return context().counters().dispatches - before;
  };
  draw({0.3, 0.2, -1}, VIEW_DEPTH);
  ++session_->pictures;
  EXPECT_EQ(record(), 0u) << "nobody looks";
  histogram.wanted = true;
  EXPECT_GT(record(), 0u);
  ASSERT_TRUE(histogram.counts);
  EXPECT_EQ(record(), 0u) << "the picture is the same";

  // Counted again by the host. The axis holds all of the values; bins of one width.
  const auto texels = [&] {
    const std::vector<std::byte> bytes = download(context(), session_->targets.linear);
    std::vector<glm::vec4> out(bytes.size() / sizeof(glm::vec4));
    std::memcpy(out.data(), bytes.data(), bytes.size());
    return out;
  };
  const auto expect = [&](uint32_t channel, auto&& valueOf) {
    const Histogram& h = histogram.counts->histogram;
    std::vector<uint32_t> wanted(HISTOGRAM_BINS);
    uint32_t outside = 0, apart = 0;
    for (const glm::vec4& texel : texels()) {
      if (texel.w == 0) continue;
      const double at = (double{valueOf(texel)} - h.low) / (double{h.high} - h.low) * HISTOGRAM_BINS;
      if (at < 0 || at > HISTOGRAM_BINS)
        ++outside;
      else
        ++wanted[std::min(static_cast<uint32_t>(at), HISTOGRAM_BINS - 1)];
    }
    for (uint32_t bin = 0; bin < HISTOGRAM_BINS; ++bin)
      apart += static_cast<uint32_t>(
          std::abs(static_cast<int>(h.counts[channel * HISTOGRAM_BINS + bin]) - static_cast<int>(wanted[bin])));
    EXPECT_LE(apart, 4u) << "values on the edge of a bin, by rounding; channel " << channel;
    return outside;
  };
  EXPECT_EQ(expect(3, [](const glm::vec4& v) { return v.x; }), 0u);
  EXPECT_EQ(histogram.counts->histogram.below + histogram.counts->histogram.above, 0u);
  // While an end of the range is dragged the axis stays.
  histogram.axis = glm::vec2(0.1f, 0.5f);
  EXPECT_GT(record(), 0u);
  EXPECT_EQ(histogram.counts->histogram.high, 0.5f);
  const uint32_t outside = expect(3, [](const glm::vec4& v) { return v.x; });
  EXPECT_EQ(outside, histogram.counts->histogram.below + histogram.counts->histogram.above);
  EXPECT_GT(outside, 0u);
  histogram.axis.reset();

  draw({0.3, 0.2, -1}, VIEW_LIT);
  ++session_->pictures;
  record();
  expect(0, [](const glm::vec4& v) { return v.x; });
  expect(2, [](const glm::vec4& v) { return v.z; });
  const uint32_t beyond = expect(3, [](const glm::vec4& v) { return luminance(glm::vec3(v)); });
  EXPECT_EQ(beyond, histogram.counts->histogram.above);
  histogram.wanted = false;
  EXPECT_EQ(record(), 0u);
  EXPECT_FALSE(histogram.counts);
}

TEST_F(InspectionTest, FollowsLinksAndGoesBack) {
  draw({0, 0, -1}, VIEW_LIT);
  pick({32, 24});
  const uint32_t first = inspection().facet()->facet, second = inspection().facet()->row.links.at(0).facet;
  inspection().follow = second;
  EXPECT_TRUE(inspection().serve(*session_));
  EXPECT_EQ(inspection().facet()->facet, second);
  EXPECT_EQ(inspection().trail, std::vector{first});
  inspection().goBack = true;
  EXPECT_TRUE(inspection().serve(*session_));
  EXPECT_EQ(inspection().facet()->facet, first);
  EXPECT_TRUE(inspection().trail.empty());

  // A ray beyond the last is taken as the last; a second pick is compared with, not shown.
  inspection().traceRay = 1000;
  inspection().serve(*session_);
  ASSERT_TRUE(inspection().ray);
  EXPECT_EQ(inspection().ray->ray, 31u);
  draw({1, 0, 0}, VIEW_LIT);
  pick({10, 10}, /*compare=*/true);
  EXPECT_EQ(inspection().facet()->facet, first);
  ASSERT_TRUE(inspection().other && inspection().comparison);
  EXPECT_NE(inspection().other->facet, first);
  EXPECT_EQ(inspection().shown, Inspection::Show::Comparison);
  // Another pick begins anew.
  pick({32, 24});
  EXPECT_FALSE(inspection().other || inspection().ray);
  EXPECT_EQ(inspection().shown, Inspection::Show::Row);
}

TEST_F(InspectionTest, ARelightIsTakenOver) {
  draw({0, 0, -1}, VIEW_LIT);
  pick({32, 24});
  inspection().wantReplay = true;
  inspection().serve(*session_);
  ASSERT_TRUE(inspection().replay);
  const glm::dvec3 before = inspection().facet()->radiosity;
  const uint32_t facet = inspection().facet()->facet;
  const uint64_t serial = inspection().serial;
  ASSERT_EQ(inspection().live.size(), 1u);

  Settings settings = session_->pipeline->settings();
  settings.solver.gpu.lambda = 0.5f;
  session_->pipeline->set(settings);
  build();
  EXPECT_TRUE(inspection().serve(*session_));
  EXPECT_GT(inspection().serial, serial);
  EXPECT_EQ(inspection().facet()->facet, facet);
  EXPECT_EQ(inspection().live.size(), 2u);
  EXPECT_GT(inspection().live.back().sweep, 0u);
  EXPECT_FALSE(inspection().replay) << "of the old light";
  EXPECT_LT(inspection().facet()->radiosity.x, before.x);
  EXPECT_FALSE(inspection().serve(*session_));
}

TEST_F(InspectionTest, ARebuildKeepsThePlaceAndAnotherSceneDropsIt) {
  draw({0, 0, -1}, VIEW_LIT);
  pick({32, 24});
  const glm::dvec3 place = inspection().facet()->position;
  Settings settings = session_->pipeline->settings();
  settings.voxel.resolution = 24;
  session_->pipeline->set(settings);
  build();
  EXPECT_TRUE(inspection().serve(*session_));
  ASSERT_TRUE(inspection().facet());
  EXPECT_LT(glm::distance(inspection().facet()->position, place), 1.0 / 16);
  EXPECT_NEAR(inspection().edge(), 1.0 / 24, 1e-3);

  // While there is nothing valid to look at, requests are answered in words.
  session_->halted = true;
  EXPECT_FALSE(inspection().serve(*session_));
  EXPECT_TRUE(pick({32, 24}));
  EXPECT_EQ(session_->messages.size(), 1u);
  EXPECT_FALSE(inspection().wanted());
  session_->halted = false;

  load(furnaceBox(0.2f));
  EXPECT_TRUE(inspection().serve(*session_));
  EXPECT_FALSE(inspection().facet());
  EXPECT_THROW(inspection().open(*session_, {8, 8, 8}), UsageError);
  inspection().open(*session_, {1, 8, 8});
  EXPECT_TRUE(inspection().facet());
}

}  // namespace
}  // namespace irad::test::inspection_suite

#endif
