#include "gi/sweep.h"

#include <algorithm>

namespace irad {
namespace {

SolverKernel chooseKernel(const Device& device, SolverKernel asked) {
  if (asked != SolverKernel::automatic) return asked;
  // lavapipe loads lane by lane: reductions across lanes only add to it. GPUs want consecutive entries per subgroup.
  return device.isCpu ? SolverKernel::row : SolverKernel::subgroup;
}

}  // namespace

Sweep::Sweep(Context& context, const FacetList& facets, const FormFactors& matrix, const SolverSettings& settings)
    : omega(settings.gpu.omega),
      flush(settings.gpu.flush),
      facets_(facets),
      matrix_(matrix),
      lambda_(settings.gpu.lambda),
      kernel_(chooseKernel(context.device, settings.kernel)) {
  const uint32_t height = (facets.count + SOLVE_IMAGE_WIDTH - 1) / SOLVE_IMAGE_WIDTH;
  images_ = context.device.isCpu && kernel_ == SolverKernel::row && matrix.format == MatrixFormat::csr &&
            height <= context.device.limits.maxImageDimension2D;
  if (!images_) return;
  ImageDesc desc;
  desc.name = "solver vector";
  desc.subsystem = Subsystem::Solver;
  desc.format = VK_FORMAT_R32G32B32A32_SFLOAT;
  desc.width = SOLVE_IMAGE_WIDTH;
  desc.height = height;
  for (Image& image : vectors_) image = Image(context.device, desc);
}

void Sweep::begin(Frame& frame, const char* stage, const Buffer& input) {
  if (!images_) return;
  frame.pass(stage)
      .shader("gi/solve_image.comp")
      .read(input)
      .write(vectors_[0])
      .push(SolveImagePush{input.address, facets_.count, 0})
      .dispatch(facets_.count);
  current_ = 0;
}

void Sweep::record(Frame& frame, const char* stage, uint32_t work, const Buffer& input, const Buffer& output,
                   const Lighting& light) {
  SolvePush push{};
  push.matrix = matrix_.record.address;
  push.facets = facets_.record.address;
  push.direct = light.direct.address;
  push.input_ = input.address;
  push.output_ = output.address;
  push.indirect = light.indirect.address;
  push.residual = light.residual.address;
  push.rowSum = light.rowSum.address;
  push.correction = light.correction.address;
  push.corrected = light.correction ? 1 : 0;
  push.lambda = lambda_;
  push.omega = omega;
  push.flush = flush;
  Pass pass = frame.pass(stage);
  pass.constant(0, matrix_.format == MatrixFormat::csr ? SOLVE_CSR : SOLVE_PADDED)
      .constant(1, work)
      .read(matrix_.record, matrix_.rowStart, matrix_.rowInfo, facets_.record, facets_.albedo, facets_.emission,
            light.direct, input)
      .write(output)
      .push(push);
  for (const Buffer& segment : matrix_.segments) pass.read(segment);
  if (light.correction) pass.read(light.correction);
  if (work != SOLVE_PRODUCT) pass.write(light.indirect);
  if (work == SOLVE_WATCH) pass.write(light.residual, light.rowSum);
  switch (kernel_) {
    case SolverKernel::row:
      if (images_) {
        pass.read(vectors_[current_]).write(vectors_[1 - current_]);
        pass.shader("gi/solve_row_image.comp").dispatch(matrix_.rows);
        current_ = 1 - current_;
      } else {
        pass.shader("gi/solve_row.comp").dispatch(matrix_.rows);
      }
      break;
    case SolverKernel::tree: {
      const uint32_t x = std::min(matrix_.rows, 32768u);
      pass.shader("gi/solve_tree.comp").dispatchGroups(x, (matrix_.rows + x - 1) / x);
      break;
    }
    default:
      pass.shader("gi/solve_subgroup.comp").dispatch(uint64_t{matrix_.rows} * frame.context().device.subgroupSize);
  }
}

}  // namespace irad
