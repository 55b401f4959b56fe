// The window's inspector without a window: picks by pixel, links followed and left, and what becomes of a pick after a
// relight, a rebuild and another scene.
#include "tests/gi_fixture.h"

#if IRAD_UI

#define GLM_ENABLE_EXPERIMENTAL
#include <glm/gtx/quaternion.hpp>

#include "gi/lighting.h"
#include "renderer/base/error.h"
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
