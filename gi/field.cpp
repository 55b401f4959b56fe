// Distance fields over the solid set (METHOD section 3, T 5.2).
#include <algorithm>
#include <bit>
#include <utility>

#include "gi/stages.h"
#include "shaders/shared/voxelize.h"

namespace irad {
namespace {

/// Exact separable Chebyshev distance: rows, then y, then z.
Buffer recordChebyshev(Frame& frame, const char* stage, const FacetList& facets, const Buffer& gridRecord) {
  const Device& device = frame.context().device;
  const Grid& grid = facets.grid;
  const uint64_t bytes = (uint64_t{grid.voxels} + 3) / 4 * 4;
  Buffer distance(device, "chebyshev field", Subsystem::Field, bytes);
  const Buffer scratch(device, "chebyshev scratch", Subsystem::Field, bytes);
  FieldPush push{};
  push.grid = gridRecord.address;
  push.reverse = facets.reverse.address;
  push.target = distance.address;
  frame.pass(stage)
      .shader("gi/chebyshev_row.comp")
      .read(gridRecord, facets.reverse)
      .write(distance)
      .push(push)
      .dispatch(uint64_t{grid.dims.y} * grid.dims.z);
  for (push.step = 1; push.step <= 2; ++push.step) {
    const Buffer& source = push.step == 1 ? distance : scratch;
    const Buffer& target = push.step == 1 ? scratch : distance;
    push.source = source.address;
    push.target = target.address;
    frame.pass(stage)
        .shader("gi/chebyshev.comp")
        .read(gridRecord, source)
        .write(target)
        .push(push)
        .dispatch(grid.voxels);
  }
  return distance;
}

Image volumeImage(const Device& device, const Grid& grid, std::string name, VkFormat format) {
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
  FieldPush push{};
  push.grid = gridRecord.address;
  push.reverse = facets.reverse.address;
  push.target = from.address;
  frame.pass(stage)
      .shader("gi/jfa_seed.comp")
      .read(gridRecord, facets.reverse)
      .write(from)
      .push(push)
      .dispatch(grid.voxels);
  push.step = std::bit_floor(largestDimension(grid));
  for (uint32_t pass = 0; pass < passes; ++pass, push.step /= 2) {
    push.source = from.address;
    push.target = to.address;
    frame.pass(stage).shader("gi/jfa.comp").read(gridRecord, from).write(to).push(push).dispatch(grid.voxels);
    std::swap(from, to);
  }
  return from;
}

Field recordField(Frame& frame, const char* stage, const FacetList& facets, const Buffer& gridRecord,
                  FieldMethod method) {
  Field field;
  field.method = method;
  if (method == FieldMethod::chebyshev) {
    field.chebyshev = recordChebyshev(frame, stage, facets, gridRecord);
    return field;
  }
  const Device& device = frame.context().device;
  const Grid& grid = facets.grid;
  const Buffer seeds = recordJumpFlood(frame, stage, facets, gridRecord, jumpFloodPasses(grid));
  field.jfaMax = static_cast<float>(largestDimension(grid));
  field.jfaSeeds = volumeImage(device, grid, "jfa seeds", VK_FORMAT_R32_UINT);
  field.jfaDistance = volumeImage(device, grid, "jfa distance", VK_FORMAT_R8_UNORM);
  FieldPush push{};
  push.grid = gridRecord.address;
  push.source = seeds.address;
  push.scale = 1.0f / field.jfaMax;
  frame.pass(stage)
      .shader("gi/jfa_distance.comp")
      .read(gridRecord, seeds)
      .write(field.jfaDistance, field.jfaSeeds)
      .push(push)
      .dispatch(grid.voxels);
  return field;
}

Field buildField(Context& context, const FacetList& facets, const Settings& settings) {
  const Buffer gridRecord = makeBuffer<Grid>(context, "grid", Subsystem::Field, std::span(&facets.grid, 1));
  Frame frame = context.begin();
  Field field = recordField(frame, "GI SDF", facets, gridRecord, settings.field.method);
  frame.submitAndWait();
  return field;
}

}  // namespace irad
