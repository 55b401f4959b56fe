#include "gi/views/fields.h"

#include <algorithm>
#include <utility>

#include "gi/facets.h"
#include "gi/field.h"
#include "gi/matrix.h"
#include "gi/subsystems.h"
#include "gi/thesis/jump_flood.h"
#include "renderer/base/error.h"
#include "renderer/frame/frame.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/solve.h"
#include "shaders/shared/view.h"

namespace irad {
namespace {

constexpr const char* kFieldsStage = "View fields";

}  // namespace

const Buffer& ViewFields::grid(Frame& frame, const FacetList& facets) {
  if (!grid_) {
    grid_ = Buffer(frame.context().device, "view: grid", Subsystem::Field, sizeof(Grid));
    frame.pass(kFieldsStage).update(grid_, facets.grid);
  }
  return grid_;
}

ViewFields::Bytes ViewFields::bytes(Frame& frame, const FacetList& facets, const Field* inUse, FieldMethod method) {
  const bool have = inUse != nullptr && *inUse && inUse->method == method;
  if (method == FieldMethod::chebyshev) {
    if (have) return {inUse->chebyshev, 1.0f};
    if (!chebyshev_)
      chebyshev_ = recordField(frame, kFieldsStage, facets, grid(frame, facets), FieldMethod::chebyshev).chebyshev;
    return {chebyshev_, 1.0f};
  }
  const glm::uvec3 dims = facets.grid.dims;
  if (!jfa_) {
    Field made;
    if (!have) made = recordField(frame, kFieldsStage, facets, grid(frame, facets), FieldMethod::jfa);
    jfa_ = Buffer(frame.context().device, "view: jfa distance", Subsystem::Field,
                  (uint64_t{facets.grid.voxels} + 3) / 4 * 4);
    frame.pass(kFieldsStage).copy(have ? inUse->jumpFlood.distance : made.jumpFlood.distance, jfa_);
  }
  return {jfa_, static_cast<float>(std::max({dims.x, dims.y, dims.z})) / 255.0f};
}

const Buffer& ViewFields::seeds(Frame& frame, const FacetList& facets, uint32_t passes) {
  passes = std::min(passes, jumpFloodPasses(facets.grid));
  if (!seeds_ || seedPasses_ != passes) {
    seeds_ = recordJumpFlood(frame, kFieldsStage, facets, grid(frame, facets), passes);
    seedPasses_ = passes;
  }
  return seeds_;
}

const Buffer& ViewFields::exact(Frame& frame, const FacetList& facets, uint32_t metric) {
  Buffer& distance = exact_.at(metric);
  if (distance) return distance;
  const Device& device = frame.context().device;
  const Buffer& gridRecord = grid(frame, facets);
  const uint64_t bytes = 4ull * facets.grid.voxels;
  distance = Buffer(device, "view: exact distance", Subsystem::Field, bytes);
  Buffer other(device, "view: exact distance, scratch", Subsystem::Field, bytes);
  ExactDistancePush push{};
  for (push.axis = 0; push.axis < 3; ++push.axis) {
    Pass pass = frame.pass(kFieldsStage);
    push.grid = pass.in(gridRecord);
    push.reverse = pass.in(facets.reverse);
    if (push.axis > 0) push.source = pass.in(other);
    push.target = pass.out(distance);
    pass.shader("view/exact_distance.comp")
        .constant(CONSTANT_DISTANCE_METRIC, metric)
        .push(push)
        .dispatch(facets.grid.voxels);
    if (push.axis < 2) std::swap(distance, other);
  }
  return distance;
}

const Buffer& ViewFields::row(Frame& frame, const FormFactors& matrix, uint32_t row) {
  IRAD_CHECK_OP(row, <, matrix.rows);
  const uint64_t bytes = 16ull * matrix.rows;
  if (row_.bytes != bytes) row_ = Buffer(frame.context().device, "view: matrix row", Subsystem::Matrix, bytes);
  Pass pass = frame.pass(kFieldsStage);
  pass.shader("view/matrix_row.comp")
      .constant(CONSTANT_MATRIX_FORMAT, matrix.format)
      .constant(CONSTANT_TINTED, matrix.tinted)
      .push(MatrixRowPush{pass.in(matrix.record), pass.out(row_), row, 0})
      .dispatch(matrix.rows);
  return row_;
}

}  // namespace irad
