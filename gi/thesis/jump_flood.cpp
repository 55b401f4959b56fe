#include "gi/thesis/jump_flood.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "gi/facets.h"
#include "gi/subsystems.h"
#include "renderer/frame/frame.h"
#include "shaders/shared/voxelize.h"

namespace irad {
namespace {

Image fieldImage(const Device& device, const Grid& grid, std::string name, VkFormat format) {
  ImageDesc desc;
  desc.name = std::move(name);
  desc.subsystem = Subsystem::Field;
  desc.format = format;
  desc.width = grid.dims.x;
  desc.height = grid.dims.y;
  desc.depth = grid.dims.z;
  desc.volume = true;
  return Image(device, desc);
}

uint32_t largestDimension(const Grid& grid) {
  return std::max({grid.dims.x, grid.dims.y, grid.dims.z});
}

}  // namespace

uint32_t jumpFloodPasses(const Grid& grid) {
  return static_cast<uint32_t>(std::bit_width(largestDimension(grid)));
}

/// Steps halve down to 1. The passes ping-pong between two buffers, which are read several times faster than images.
Buffer recordJumpFlood(Frame& frame, const char* stage, const FacetList& facets, const Buffer& gridRecord,
                       uint32_t passes) {
  const Device& device = frame.context().device;
  const Grid& grid = facets.grid;
  Buffer from(device, "jfa ping", Subsystem::Field, 4ull * grid.voxels);
  Buffer to(device, "jfa pong", Subsystem::Field, 4ull * grid.voxels);
  Pass seed = frame.pass(stage);
  FieldPush push{};
  push.grid = seed.in(gridRecord);
  push.reverse = seed.in(facets.reverse);
  push.target = seed.out(from);
  seed.shader("thesis/jfa_seed.comp").push(push).dispatch(grid.voxels);
  push.reverse = 0;
  push.step = std::bit_floor(largestDimension(grid));
  for (uint32_t i = 0; i < passes; ++i, push.step /= 2) {
    Pass pass = frame.pass(stage);
    push.grid = pass.in(gridRecord);
    push.source = pass.in(from);
    push.target = pass.out(to);
    pass.shader("thesis/jfa.comp").push(push).dispatch(grid.voxels);
    std::swap(from, to);
  }
  return from;
}

JumpFloodField recordJumpFloodField(Frame& frame, const char* stage, const FacetList& facets,
                                    const Buffer& gridRecord) {
  const Device& device = frame.context().device;
  const Grid& grid = facets.grid;
  const Buffer seeds = recordJumpFlood(frame, stage, facets, gridRecord, jumpFloodPasses(grid));
  JumpFloodField field;
  field.largest = static_cast<float>(largestDimension(grid));
  field.seeds = fieldImage(device, grid, "jfa seeds", VK_FORMAT_R32_UINT);
  field.distance = fieldImage(device, grid, "jfa distance", VK_FORMAT_R8_UNORM);
  Pass pass = frame.pass(stage);
  FieldPush push{};
  push.grid = pass.in(gridRecord);
  push.source = pass.in(seeds);
  push.scale = 1.0f / field.largest;
  pass.shader("thesis/jfa_distance.comp").write(field.distance, field.seeds).push(push).dispatch(grid.voxels);
  return field;
}

}  // namespace irad
