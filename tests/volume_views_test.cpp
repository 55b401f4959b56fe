// Volumes as slices, cubes, projections and isosurfaces, seen from straight above: a pixel is a column of voxels.
#include <gtest/gtest.h>

#include "gi/facets.h"
#include "gi/field.h"
#include "gi/oracle/fields.h"
#include "gi/subsystems.h"
#include "gi/thesis/jump_flood.h"
#include "gi/views/fields.h"
#include "shaders/shared/view.h"
#include "shaders/shared/voxelize.h"
#include "tests/forward_support.h"

namespace irad::test::volume_views_suite {
namespace {

/// A floor with a block on it.
Scene blockScene() {
  SceneBuilder b;
  b.scene.materials[0].baseColor = {0.5f, 0.25f, 0.75f, 1};
  b.addQuad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
  b.addBox({-0.5f, 0.8f, -1.2f}, {0.7f, 1.9f, 0.3f});
  return b.finish();
}

Settings blockSettings() {
  Settings settings;
  settings.voxel.resolution = 19;
  return settings;
}

/// The scene's voxels, and pictures of them of one pixel per column.
struct FromAbove {
  Context& context;
  Stage stage;
  FacetList facets;
  Field field;
  ViewFields fields;

  explicit FromAbove(Context& c, Settings settings = blockSettings()) : context(c), stage(c, blockScene(), settings) {
    facets = makeFacets(context, stage.device, settings);
    field = buildField(context, facets, settings);
    const Grid& grid = facets.grid;
    const glm::dvec3 size = glm::dvec3(grid.dims) * double(grid.edge),
                     low = stage.scene.origin + glm::dvec3(grid.origin);
    Camera camera;
    camera.position = low + size * glm::dvec3(0.5, 1, 0.5) + glm::dvec3(0, 1, 0);
    camera.orientation = glm::angleAxis(-glm::pi<float>() / 2, glm::vec3(1, 0, 0));  // looks down -Y, the top is -Z
    camera.orthographic = true;
    camera.ymag = static_cast<float>(size.z / 2);
    stage.scene.cameras = {camera};
  }
  const glm::uvec3& dims() const { return facets.grid.dims; }
  Picture draw(View view) {
    return stage.draw(view, {dims().x, dims().z}, 0,
                      {.scene = &stage.device, .facets = &facets, .field = &field, .fields = &fields});
  }
  Picture slice(View view, uint32_t layer) {
    stage.settings.view.shape = ViewShape::slice;
    stage.settings.view.slice = (static_cast<float>(layer) + 0.5f) / static_cast<float>(dims().y);
    return draw(view);
  }
  uint32_t index(uint32_t x, uint32_t y, uint32_t z) const { return voxelIndex({x, y, z}, dims()); }
  std::vector<bool> solid() {
    std::vector<bool> out;
    for (const uint32_t entry : downloadAs<uint32_t>(context, facets.reverse)) out.push_back(entry != NO_FACET);
    return out;
  }
  template <class F>
  void forEachColumn(F&& f) const {
    for (uint32_t z = 0; z < dims().z; ++z)
      for (uint32_t x = 0; x < dims().x; ++x) f(x, z);
  }
};

class VolumeViews : public GpuTest {};

TEST_F(VolumeViews, SlicesOfTheFieldsAreTheFields) {
  FromAbove world(context());
  const std::vector<bool> solid = world.solid();
  const std::vector<uint8_t> chebyshev = oracle::chebyshev(world.facets.grid, solid);
  const std::vector<uint32_t> squared = oracle::squaredDistance(world.facets.grid, solid);
  const float step = static_cast<float>(std::max({world.dims().x, world.dims().y, world.dims().z})) / 255;
  for (const uint32_t layer : {0u, 3u, world.dims().y - 1}) {
    SCOPED_TRACE(layer);
    const Picture c = world.slice(VIEW_DISTANCE_CHEBYSHEV, layer), used = world.slice(VIEW_DISTANCE, layer);
    const Picture jfa = world.slice(VIEW_DISTANCE_JFA, layer), field = world.slice(VIEW_JFA_FIELD_ERROR, layer);
    const Picture flood = world.slice(VIEW_JFA_ERROR, layer), exact = world.slice(VIEW_CHEBYSHEV_ERROR, layer);
    EXPECT_EQ(c.linear, used.linear);
    world.forEachColumn([&](uint32_t x, uint32_t z) {
      const uint32_t i = world.index(x, layer, z);
      const float distance = std::sqrt(static_cast<float>(squared[i]));
      ASSERT_EQ(c.at(x, z).x, chebyshev[i]);
      ASSERT_EQ(exact.at(x, z).x, 0);
      ASSERT_GE(flood.at(x, z).x, 0);
      ASSERT_LT(flood.at(x, z).x, 1);
      // The stored field is the flood's, to half a step of its 8 bits.
      ASSERT_NEAR(jfa.at(x, z).x, distance + flood.at(x, z).x, 0.501f * step);
      ASSERT_NEAR(field.at(x, z).x, jfa.at(x, z).x - distance, 1e-5);
    });
  }
}

TEST_F(VolumeViews, TheOtherFieldIsTheSameUnderEitherMethod) {
  Settings jfa = blockSettings();
  jfa.field.method = FieldMethod::jfa;
  FromAbove a(context()), b(context(), jfa);
  for (const View view : {VIEW_DISTANCE_CHEBYSHEV, VIEW_DISTANCE_JFA, VIEW_JFA_FIELD_ERROR})
    EXPECT_EQ(a.slice(view, 4).linear, b.slice(view, 4).linear) << view;
  EXPECT_EQ(b.slice(VIEW_DISTANCE, 4).linear, b.slice(VIEW_DISTANCE_JFA, 4).linear);
}

TEST_F(VolumeViews, SeedsAfterEveryPass) {
  FromAbove world(context());
  const Buffer grid = makeBuffer<Grid>(context(), "grid", Subsystem::Field, std::span(&world.facets.grid, 1));
  const uint32_t last = jumpFloodPasses(world.facets.grid), layer = 7;
  uint64_t known = 0;
  for (uint32_t pass = 0; pass <= last + 1; ++pass) {
    Frame frame = context().begin();
    const Buffer flood = recordJumpFlood(frame, "test", world.facets, grid, std::min(pass, last));
    frame.submitAndWait();
    const std::vector<uint32_t> seeds = downloadAs<uint32_t>(context(), flood);
    world.stage.settings.view.jfaPass = pass;
    const Picture shown = world.slice(VIEW_JFA_SEEDS, layer);
    uint64_t drawn = 0;
    world.forEachColumn([&](uint32_t x, uint32_t z) {
      const uint32_t seed = seeds[world.index(x, layer, z)];
      const glm::vec4 c = shown.at(x, z);
      if (seed == NO_SEED) {
        ASSERT_EQ(c.w, 0);
        return;
      }
      ++drawn;
      ASSERT_GT(c.w, 0);
      ASSERT_EQ(glm::uvec3(c), unpackVoxel(seed));
    });
    EXPECT_GE(drawn, known) << pass;
    known = drawn;
  }
  EXPECT_EQ(known, world.dims().x * world.dims().z);
}

TEST_F(VolumeViews, ASliceOfFacetsShowsTheSolidVoxelsAlone) {
  FromAbove world(context());
  const std::vector<bool> solid = world.solid();
  for (uint32_t layer = 0; layer < world.dims().y; ++layer) {
    const Picture shown = world.slice(VIEW_VOXEL_ALBEDO, layer);
    world.forEachColumn([&](uint32_t x, uint32_t z) {
      ASSERT_EQ(shown.at(x, z).w > 0, solid[world.index(x, layer, z)]) << x << ", " << layer << ", " << z;
      if (shown.at(x, z).w == 0) return;
      ASSERT_NEAR(shown.at(x, z).y, 0.25, 1e-4);
    });
  }
}

TEST_F(VolumeViews, SlicesAcrossEveryAxisGoThroughTheMiddle) {
  // Seen from above, a slice across x or z is edge-on: at most one column shows, that of the plane.
  FromAbove world(context());
  world.stage.settings.view.shape = ViewShape::slice;
  EXPECT_EQ(world.draw(VIEW_DISTANCE_CHEBYSHEV).linear,
            world.slice(VIEW_DISTANCE_CHEBYSHEV, world.dims().y / 2).linear);
  world.stage.settings.view.axis = Axis::x;
  const Picture shown = world.draw(VIEW_DISTANCE_CHEBYSHEV);
  world.forEachColumn([&](uint32_t x, uint32_t z) {
    if (x == world.dims().x / 2) return;
    ASSERT_EQ(shown.at(x, z).w, 0) << x;
  });
}

TEST_F(VolumeViews, ProjectionsSumDistancesAndAverageTheRest) {
  FromAbove world(context());
  world.stage.settings.view.shape = ViewShape::projection;
  const std::vector<bool> solid = world.solid();
  const std::vector<uint8_t> field = oracle::chebyshev(world.facets.grid, solid);
  const Picture distance = world.draw(VIEW_DISTANCE_CHEBYSHEV), albedo = world.draw(VIEW_VOXEL_ALBEDO);
  const Picture error = world.draw(VIEW_JFA_FIELD_ERROR);
  world.forEachColumn([&](uint32_t x, uint32_t z) {
    float sum = 0;
    bool any = false;
    for (uint32_t y = 0; y < world.dims().y; ++y) {
      const uint32_t i = world.index(x, y, z);
      sum += 1 / std::max(static_cast<float>(field[i]), 0.5f);
      any = any || solid[i];
    }
    ASSERT_NEAR(distance.at(x, z).x, sum, 1e-3 * sum);
    ASSERT_EQ(albedo.at(x, z).w, any ? 1 : 0);
    if (!any) return;
    ASSERT_NEAR(albedo.at(x, z).z, 0.75, 1e-3);
  });
  // Errors: the largest along the column is no smaller than that of any layer.
  for (uint32_t layer = 0; layer < world.dims().y; layer += 5) {
    const Picture one = world.slice(VIEW_JFA_FIELD_ERROR, layer);
    for (size_t i = 0; i < one.linear.size(); ++i)
      ASSERT_GE(std::abs(error.linear[i].x) + 1e-5, std::abs(one.linear[i].x));
  }
}

TEST_F(VolumeViews, CubesAndIsosurfaceAreWhereTheFieldHasTheValue) {
  FromAbove world(context());
  const std::vector<bool> solid = world.solid();
  const std::vector<uint32_t> squared = oracle::squaredDistance(world.facets.grid, solid);
  world.stage.settings.view.isovalue = 2;
  world.stage.settings.view.shape = ViewShape::cubes;
  const Picture cubes = world.draw(VIEW_JFA_FIELD_ERROR);
  const float step = static_cast<float>(std::max({world.dims().x, world.dims().y, world.dims().z})) / 255;
  world.stage.settings.view.shape = ViewShape::isosurface;
  const Picture surface = world.draw(VIEW_DISTANCE_CHEBYSHEV);
  world.forEachColumn([&](uint32_t x, uint32_t z) {
    bool any = false;
    for (uint32_t y = 0; y < world.dims().y; ++y) any = any || squared[world.index(x, y, z)] <= 4;
    ASSERT_EQ(cubes.at(x, z).w > 0, any) << x << ", " << z;
    ASSERT_LE(std::abs(cubes.at(x, z).x), 1 + step);
    // Over the middle of the floor and of the block the surface lies two voxels above, between centres that have 1
    // to 3.
    if (x > 3 && x + 4 < world.dims().x && z > 3 && z + 4 < world.dims().z) {
      ASSERT_GT(surface.at(x, z).w, 0);
      ASSERT_NEAR(surface.at(x, z).x, 2, 1);
    }
  });
}

TEST_F(VolumeViews, PinHolesAreSeenWhereVoxelsAreMissing) {
  FromAbove world(context());
  for (const glm::vec4& c : world.draw(VIEW_PIN_HOLES).linear) ASSERT_EQ(c.x, 0);
  // Take the floor's voxels away in a square of five by five: its middle is two voxels from any that is left.
  std::vector<uint32_t> reverse = downloadAs<uint32_t>(context(), world.facets.reverse);
  for (uint32_t z = 2; z < 7; ++z)
    for (uint32_t x = 2; x < 7; ++x)
      for (uint32_t y = 0; y < world.dims().y; ++y) reverse[world.index(x, y, z)] = NO_FACET;
  upload(context(), world.facets.reverse, std::as_bytes(std::span(reverse)));
  const Picture holes = world.draw(VIEW_PIN_HOLES);
  EXPECT_EQ(holes.at(4, 4).x, 2);
  EXPECT_NEAR(holes.at(2, 4).x, 0.5, 0.05);  // of its pixel's centre
  EXPECT_NEAR(holes.at(3, 4).x, 1.5, 0.05);
  EXPECT_EQ(holes.at(1, 4).x, 0);
}

TEST_F(VolumeViews, FieldsAreMadeOnceAndGivenUpWhenNothingShowsThem) {
  FromAbove world(context());
  const auto held = [&] {
    uint64_t bytes = 0;
    for (const MemoryRow& row : context().device.memory().rows())
      if (row.subsystem == Subsystem::Field) bytes += row.bytes;
    return bytes;
  };
  (void)world.draw(VIEW_LIT);
  context().finish();
  const uint64_t before = held();
  (void)world.slice(VIEW_JFA_FIELD_ERROR, 4);
  (void)world.slice(VIEW_JFA_FIELD_ERROR, 5);
  EXPECT_GT(held(), before);
  (void)world.draw(VIEW_LIT);
  context().device.waitIdle();
  (void)world.draw(VIEW_LIT);
  EXPECT_EQ(held(), before);
}

}  // namespace
}  // namespace irad::test::volume_views_suite
