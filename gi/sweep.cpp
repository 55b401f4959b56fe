#include "gi/sweep.h"

#include <vector>

#include "gi/facets.h"
#include "gi/host_pass.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/sweep_on_host.h"
#include "renderer/frame/frame.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/solve.h"

namespace irad {
namespace {

/// Entries per row up to which a GPU is faster with an invocation per row: row over subgroup took .63 and .66 of a
/// relight's time with 22 and 19 entries, .92 with 51, 1.0 with 60, 1.2 and 1.4 with 125 and 166 (H200, Sponza, park
/// and Box, docs/accuracy.md).
constexpr double kShortRow = 56;

SolverKernel chooseKernel(const Device& device, const FacetList& facets, const FormFactors& matrix,
                          SolverKernel asked) {
  if (asked != SolverKernel::automatic) return asked;
  // lavapipe loads lane by lane: reductions across lanes only add to it. GPUs want consecutive entries per subgroup,
  // where there are enough of them.
  if (device.isCpu) return SolverKernel::row;
  const double entries = static_cast<double>(matrix.stats.entries);
  const bool fewEntries = matrix.format == MatrixFormat::csr && entries < kShortRow * facets.count;
  return fewEntries ? SolverKernel::row : SolverKernel::subgroup;
}

}  // namespace

Sweep::Sweep(Context& context, const FacetList& facets, const FormFactors& matrix, const SolverSettings& settings)
    : omega(settings.gpu.omega),
      flush(settings.gpu.flush),
      facets_(facets),
      matrix_(matrix),
      lambda_(settings.gpu.lambda),
      kernel_(chooseKernel(context.device, facets, matrix, settings.kernel)),
      gains_(kernel_ == SolverKernel::tree ? chooseKernel(context.device, facets, matrix, SolverKernel::automatic)
                                           : kernel_),
      onHost_(context.device.isCpu && settings.kernel == SolverKernel::automatic &&
              matrix.format == MatrixFormat::csr) {}

template <class AnyPass>
SolvePush Sweep::rowsToSum(AnyPass& pass, uint32_t work, const Buffer& input, const Buffer& output,
                           const Lighting& light, uint32_t record) const {
  SolvePush push{};
  push.direct = pass.in(light.direct);
  push.input_ = pass.in(input);
  push.output_ = pass.out(output);
  if (work != SOLVE_PRODUCT) push.indirect = pass.out(light.indirect);
  if (work == SOLVE_WATCH || work == SOLVE_GAINS) {
    push.residual = pass.out(light.residual, sizeof(SolveResidual) * record);
    push.rowSum = pass.out(light.rowSum);
  }
  push.correction = pass.inIfAny(light.correction);
  push.correctionGain = light.correction ? light.gain.radiosity : 0;
  push.lambda = lambda_;
  push.omega = omega;
  push.flush = flush;
  push.sky = pass.inIfAny(light.sky);
  push.reflected = pass.inIfAny(light.writeback.used);
  return push;
}

void Sweep::sweepByHost(Frame& frame, const char* stage, uint32_t work, const Buffer& input, const Buffer& output,
                        const Lighting& light, uint32_t record) const {
  HostPass pass(frame);
  const SolvePush push = rowsToSum(pass, work, input, output, light, record);
  const FacetArrays facets = facets_.arrays([&](const Buffer& buffer) { return pass.in(buffer); });
  const MatrixRecord arrays(pass.in(matrix_.record));
  std::vector<UintArray> segments;
  for (const Buffer& segment : matrix_.segments) segments.emplace_back(pass.in(segment));
  const UintArray rowStart(pass.in(matrix_.rowStart));
  const Uvec2Array rowInfo(pass.in(matrix_.rowInfo));
  const SolveWork how{work, static_cast<bool>(light.sky), static_cast<bool>(light.writeback.used)};
  pass.run(stage, [&] {
    MatrixArrays matrix = arrays.at[0];
    matrix.segments = SegmentArray(segments.data());
    matrix.rowStart = rowStart;
    matrix.rowInfo = rowInfo;
    sweepOnHost(push, matrix, facets, how, matrix_.tinted);
  });
}

void Sweep::record(Frame& frame, const char* stage, uint32_t work, const Buffer& input, const Buffer& output,
                   const Lighting& light, uint32_t record) {
  if (onHost_) return sweepByHost(frame, stage, work, input, output, light, record);
  Pass pass = frame.pass(stage);
  SolvePush push = rowsToSum(pass, work, input, output, light, record);
  push.matrix = pass.in(matrix_.record);
  push.facets = pass.in(facets_.record);
  pass.constant(CONSTANT_MATRIX_FORMAT, matrix_.format)
      .constant(CONSTANT_TINTED, matrix_.tinted)
      .constant(CONSTANT_SOLVE_WORK, work)
      .constant(CONSTANT_SKY, static_cast<bool>(light.sky))
      .constant(CONSTANT_REFLECTED, static_cast<bool>(light.writeback.used))
      .push(push);
  switch (work == SOLVE_GAINS ? gains_ : kernel_) {
    case SolverKernel::row:
      pass.shader("gi/solve_row.comp").dispatch(matrix_.rows);
      break;
    case SolverKernel::tree:
      pass.shader("thesis/solve_tree.comp").dispatchWorkgroups(matrix_.rows);
      break;
    default:
      pass.shader("gi/solve_subgroup.comp").dispatch(uint64_t{matrix_.rows} * frame.context().device.subgroupSize);
  }
}

}  // namespace irad
