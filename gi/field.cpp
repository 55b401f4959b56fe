// Distance fields over the solid set (METHOD section 3, T 5.2).
#include <algorithm>
#include <bit>
#include <utility>

#include "gi/stages.h"
#include "renderer/error.h"
#include "shaders/shared/voxelize.h"

namespace irad {
namespace {

constexpr const char* kStage = "GI SDF";

/// Exact separable Chebyshev distance: rows, then y, then z.
void buildChebyshev(Context& context, const FacetList& facets, const Buffer& gridRecord, Field& field) {
  const Grid& grid = facets.grid;
  const uint64_t bytes = (uint64_t{grid.voxels} + 3) / 4 * 4;
  field.chebyshev = Buffer(context.device, "chebyshev field", Subsystem::Field, bytes);
  Buffer scratch(context.device, "chebyshev scratch", Subsystem::Field, bytes);
  FieldPush push{};
  push.grid = gridRecord.address;
  push.reverse = facets.reverse.address;
  push.target = field.chebyshev.address;
  Frame frame = context.begin();
  frame.pass(kStage)
      .shader("gi/chebyshev_row.comp")
      .read(gridRecord, facets.reverse)
      .write(field.chebyshev)
      .push(push)
      .dispatch(uint64_t{grid.dims.y} * grid.dims.z);
  for (push.step = 1; push.step <= 2; ++push.step) {
    const Buffer& source = push.step == 1 ? field.chebyshev : scratch;
    const Buffer& target = push.step == 1 ? scratch : field.chebyshev;
    push.source = source.address;
    push.target = target.address;
    frame.pass(kStage)
        .shader("gi/chebyshev.comp")
        .read(gridRecord, source)
        .write(target)
        .push(push)
        .dispatch(grid.voxels);
  }
  frame.submitAndWait();
}

Image seedImage(const Device& device, const Grid& grid, std::string name) {
  ImageDesc desc;
  desc.name = std::move(name);
  desc.subsystem = Subsystem::Field;
  desc.format = VK_FORMAT_R32_UINT;
  desc.width = grid.dims.x;
  desc.height = grid.dims.y;
  desc.depth = grid.dims.z;
  desc.volume = true;
  return Image(device, desc);
}

/// Jump flooding: floor(log2(largest dimension)) + 1 passes, steps halving down to 1. The passes ping-pong between two
/// buffers, which are read several times faster than images; every pass is copied to an image where asked for.
void buildJumpFlood(Context& context, const FacetList& facets, const Buffer& gridRecord, bool keepPasses,
                    Field& field) {
  const Grid& grid = facets.grid;
  const uint32_t largest = std::max({grid.dims.x, grid.dims.y, grid.dims.z});
  field.jfaMax = static_cast<float>(largest);
  field.jfaSeeds = seedImage(context.device, grid, "jfa seeds");
  ImageDesc desc = field.jfaSeeds.desc;
  desc.name = "jfa distance";
  desc.format = VK_FORMAT_R8_UNORM;
  field.jfaDistance = Image(context.device, desc);
  Buffer from(context.device, "jfa ping", Subsystem::Field, 4ull * grid.voxels);
  Buffer to(context.device, "jfa pong", Subsystem::Field, 4ull * grid.voxels);

  FieldPush push{};
  push.grid = gridRecord.address;
  push.reverse = facets.reverse.address;
  push.target = from.address;
  Frame frame = context.begin();
  frame.pass(kStage)
      .shader("gi/jfa_seed.comp")
      .read(gridRecord, facets.reverse)
      .write(from)
      .push(push)
      .dispatch(grid.voxels);
  for (push.step = std::bit_floor(largest); push.step >= 1; push.step /= 2) {
    push.source = from.address;
    push.target = to.address;
    frame.pass(kStage).shader("gi/jfa.comp").read(gridRecord, from).write(to).push(push).dispatch(grid.voxels);
    if (keepPasses) {
      field.jfaPasses.push_back(seedImage(context.device, grid, fmt::format("jfa pass, step {}", push.step)));
      frame.pass(kStage).copy(to, field.jfaPasses.back());
    }
    std::swap(from, to);
  }
  push.source = from.address;
  push.scale = 1.0f / field.jfaMax;
  frame.pass(kStage)
      .shader("gi/jfa_distance.comp")
      .read(gridRecord, from)
      .write(field.jfaDistance, field.jfaSeeds)
      .push(push)
      .dispatch(grid.voxels);
  frame.submitAndWait();
}

}  // namespace

Field buildField(Context& context, const FacetList& facets, const Settings& settings) {
  Field field;
  field.method = settings.field.method;
  const Buffer gridRecord = makeBuffer<Grid>(context, "grid", Subsystem::Field, std::span(&facets.grid, 1));
  if (field.method == FieldMethod::chebyshev)
    buildChebyshev(context, facets, gridRecord, field);
  else
    buildJumpFlood(context, facets, gridRecord, settings.field.keepPasses, field);
  return field;
}

}  // namespace irad
