#include "gi/view_fields.h"

#include <algorithm>
#include <utility>

#include "renderer/error.h"
#include "shaders/shared/solve.h"
#include "shaders/shared/view.h"

namespace irad {
namespace {

constexpr const char* kStage = "View fields";

}  // namespace

const Buffer& ViewFields::grid(Frame& frame, const FacetList& facets) {
  if (!grid_) {
    grid_ = Buffer(frame.context().device, "view: grid", Subsystem::Field, sizeof(Grid));
    frame.pass(kStage).update(grid_, facets.grid);
  }
  return grid_;
}

ViewFields::Bytes ViewFields::bytes(Frame& frame, const FacetList& facets, const Field* inUse, FieldMethod method) {
  const bool have = inUse != nullptr && *inUse && inUse->method == method;
  if (method == FieldMethod::chebyshev) {
    if (have) return {inUse->chebyshev, 1.0f};
    if (!chebyshev_)
      chebyshev_ = recordField(frame, kStage, facets, grid(frame, facets), FieldMethod::chebyshev).chebyshev;
    return {chebyshev_, 1.0f};
  }
  const glm::uvec3 dims = facets.grid.dims;
  if (!jfa_) {
    Field made;
    if (!have) made = recordField(frame, kStage, facets, grid(frame, facets), FieldMethod::jfa);
    jfa_ = Buffer(frame.context().device, "view: jfa distance", Subsystem::Field,
                  (uint64_t{facets.grid.voxels} + 3) / 4 * 4);
    frame.pass(kStage).copy(have ? inUse->jfaDistance : made.jfaDistance, jfa_);
  }
  return {jfa_, static_cast<float>(std::max({dims.x, dims.y, dims.z})) / 255.0f};
}

const Buffer& ViewFields::seeds(Frame& frame, const FacetList& facets, uint32_t passes) {
  passes = std::min(passes, jumpFloodPasses(facets.grid));
  if (!seeds_ || seedPasses_ != passes) {
    seeds_ = recordJumpFlood(frame, kStage, facets, grid(frame, facets), passes);
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
  push.grid = gridRecord.address;
  push.reverse = facets.reverse.address;
  for (push.axis = 0; push.axis < 3; ++push.axis) {
    push.source = other.address;  // unread along the first axis
    push.target = distance.address;
    Pass pass = frame.pass(kStage);
    pass.shader("view/exact_distance.comp").constant(0, metric).read(gridRecord, facets.reverse);
    if (push.axis > 0) pass.read(other);
    pass.write(distance).push(push).dispatch(facets.grid.voxels);
    if (push.axis < 2) std::swap(distance, other);
  }
  return distance;
}

const Buffer& ViewFields::row(Frame& frame, const FormFactors& matrix, uint32_t row) {
  IRAD_CHECK_OP(row, <, matrix.rows);
  const uint64_t bytes = 16ull * matrix.rows;
  if (row_.bytes != bytes) row_ = Buffer(frame.context().device, "view: matrix row", Subsystem::Matrix, bytes);
  Pass pass = frame.pass(kStage);
  pass.shader("view/matrix_row.comp")
      .constant(0, matrix.format == MatrixFormat::csr ? SOLVE_CSR : SOLVE_PADDED)
      .read(matrix.record, matrix.rowStart, matrix.rowInfo)
      .write(row_)
      .push(MatrixRowPush{matrix.record.address, row_.address, row, 0});
  for (const Buffer& segment : matrix.segments) pass.read(segment);
  pass.dispatch(matrix.rows);
  return row_;
}

}  // namespace irad
